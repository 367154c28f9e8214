"""Confusions and shares of recognition alone, on two recordings by hand."""

import numpy as np
import pytest
from inhand_lab.recognition.movement_alone import RecognisedRecording, RecognitionAlone


def recording(action: int, by_pose: list[int], likeliest: list[int]) -> RecognisedRecording:
    """Frames in which an action has a probability of 0.6, the other 0.1, and none 0.3."""
    probabilities = np.full((len(likeliest), 3), 0.1)
    probabilities[np.arange(len(likeliest)), likeliest] = 0.6
    probabilities[:, 2] = 0.3
    return RecognisedRecording(action, "p", np.array(by_pose), probabilities)


ALONE = RecognitionAlone(
    ("sweep", "drink"),
    (recording(0, [0, 1, 1, 1], [1, 0, 0, 0]), recording(1, [1, 1], [0, 1])),
)


def test_a_row_of_a_confusion_is_what_a_true_action_is_taken_for() -> None:
    np.testing.assert_allclose(ALONE.confusion(sequences=False), [[0.75, 0.25], [0.5, 0.5]])


def test_a_whole_recording_is_the_action_that_is_likeliest_on_average() -> None:
    assert [one.sequence for one in ALONE.recordings] == [0, 0]
    np.testing.assert_allclose(ALONE.confusion(sequences=True), [[1.0, 0.0], [1.0, 0.0]])


def test_shares_are_of_frames_by_pose_of_frames_over_time_and_of_recordings() -> None:
    summary = ALONE.summary()
    assert summary["frames_by_pose_percent"] == pytest.approx(100.0 * 3 / 6)
    assert summary["frames_percent"] == pytest.approx(100.0 * 4 / 6)
    assert summary["sequences_percent"] == pytest.approx(50.0)
