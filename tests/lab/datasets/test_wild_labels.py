"""Labels that jump for a moment."""

import numpy as np
import pytest
from inhand_lab.datasets.tracks import Track
from inhand_lab.datasets.wild_labels import wild_labels, without_wild_labels
from scipy.spatial.transform import Rotation


def swung(frames: int = 240, rate: float = 240.0) -> tuple[Track, np.ndarray]:
    """A club that turns by 40 rad/s, and its frames' times."""
    seconds = np.arange(frames) / rate
    turns = Rotation.from_rotvec(np.outer(40.0 * seconds, [0.0, 0.0, 1.0]))
    places = np.stack((np.cos(40.0 * seconds), np.sin(40.0 * seconds), 0.0 * seconds), axis=1)
    track = Track(places, turns.as_quat(canonical=True, scalar_first=True))
    return track, np.rint(1e9 * seconds).astype(np.int64)


def turned(track: Track, frames: slice, angle: float) -> None:
    other = Rotation.from_rotvec([angle, 0.0, 0.0])
    own = Rotation.from_quat(track.rotations[frames], scalar_first=True)
    track.rotations[frames] = (own * other).as_quat(canonical=True, scalar_first=True)


@pytest.mark.parametrize("rate", [30.0, 240.0])
@pytest.mark.parametrize("frame", [0, 7, 100, 239])
def test_a_single_wild_label_is_found_and_no_other(frame: int, rate: float) -> None:
    for spoil in (
        lambda track: turned(track, slice(frame, frame + 1), 3.0),
        lambda track: track.translations.__setitem__(frame, (5.0, 5.0, 5.0)),
    ):
        track, times_ns = swung(rate=rate)
        spoil(track)
        assert np.flatnonzero(wild_labels(track, times_ns)).tolist() == [frame]


def test_fast_labels_that_follow_from_each_other_are_none_of_them_wild() -> None:
    assert not wild_labels(*swung()).any()


def test_labels_may_jump_while_they_are_not_given() -> None:
    track, times_ns = swung()
    track.translations[100], track.rotations[100] = np.nan, np.nan
    track.translations[101:] += 5.0
    assert not wild_labels(track, times_ns).any()


@pytest.mark.parametrize("rate", [30.0, 240.0])
def test_what_is_turned_over_for_good_is_not_taken_for_a_moment(rate: float) -> None:
    """Training refuses it: nobody can say which half is right."""
    track, times_ns = swung(rate=rate)
    turned(track, slice(120, 240), np.pi)
    assert not wild_labels(track, times_ns).any()


def test_where_every_tenth_label_is_wild_none_is_passed_over() -> None:
    track, times_ns = swung()
    track.translations[::10] += 3.0
    assert not wild_labels(track, times_ns).any()


def test_a_warning_names_the_recording_and_the_frames_that_are_left_out(
    caplog: pytest.LogCaptureFixture,
) -> None:
    track, times_ns = swung()
    turned(track, slice(43, 44), 3.0)
    left = without_wild_labels("recordings/swing.mcap", track, times_ns)
    assert "recordings/swing.mcap: 1 label is" in caplog.text
    assert caplog.text.rstrip().endswith("frame 43")
    assert np.flatnonzero(~left.given).tolist() == [43]
