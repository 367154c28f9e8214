"""How nearly body poses come back."""

import subprocess
import sys

import numpy as np
import pytest
from inhand_lab.realism.repeatability import (
    BodyPoseSequence,
    body_pose_sequence,
    distance_to_others,
    return_distance,
    return_distance_by_joint,
)
from inhand_tracker.body.skeleton import mirror_joints
from waving import STANDING, waving, write_dataset

RATE = 30.0


def recording(participant: str, *places: float) -> BodyPoseSequence:
    """BodyPoseSequence a second apart along one axis of body space."""
    bodies = np.zeros((len(places), 60))
    bodies[:, 0] = places
    return BodyPoseSequence(participant, np.arange(len(places), dtype=float), bodies)


def test_a_pose_is_done_again_in_another_recording_of_the_same_person() -> None:
    recordings = [recording("a", 0.0, 1.0), recording("a", 0.1, 1.3), recording("b", 0.0, 1.0)]
    assert return_distance(recordings[:2]) == pytest.approx(0.2)


def test_within_one_recording_the_moments_around_a_pose_are_not_it_again() -> None:
    assert return_distance([recording("a", 0.0, 0.01, 0.5, 0.51)]) == pytest.approx(
        0.505, abs=0.006
    )


def test_others_are_five_at_the_most_and_never_the_same_person() -> None:
    others = [recording(f"p{n}", 1.0 + n) for n in range(5)]
    one, same, sixth = recording("a", 0.0), recording("a", 0.0), recording("z", 0.0)
    # Only the sixth has somebody in the very same place among the first five others.
    distances = [1.0] * 7 + [0.0]
    assert distance_to_others([one, same, *others, sixth]) == pytest.approx(np.mean(distances))


def test_left_handed_people_are_compared_mirrored() -> None:
    joints, _, _ = waving(4, seed=0)
    left = body_pose_sequence("a", RATE, "left", mirror_joints(joints))
    np.testing.assert_allclose(
        left.bodies, body_pose_sequence("a", RATE, "right", joints).bodies, atol=1e-9
    )


def test_joints_come_back_as_nearly_as_the_whole_body_does() -> None:
    random = np.random.default_rng(3)
    wide = np.zeros((4, 60))
    wide[:, 33:36] = random.normal(size=(4, 3))
    recordings = [
        BodyPoseSequence("a", np.arange(4.0), wide + 0.01 * number) for number in range(2)
    ]
    joints = return_distance_by_joint(recordings)
    np.testing.assert_allclose(joints, 0.01 * np.sqrt(3.0), atol=1e-12)
    assert return_distance(recordings) == pytest.approx(0.01 * np.sqrt(60.0))


def test_frames_with_a_missing_joint_are_left_out_and_keep_their_times() -> None:
    joints = np.repeat(STANDING[None], 4, axis=0)
    joints[1, 7] = np.nan
    seconds = body_pose_sequence("a", RATE, "right", joints).seconds
    np.testing.assert_allclose(seconds, np.array([0, 2, 3]) / RATE)


def test_the_command_shows_measured_joints_alone_where_no_others_are_known(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    dataset = write_dataset(tmp_path_factory.mktemp("waved"), frames=90)
    command = [sys.executable, "-m", "inhand_lab.realism.repeatability", str(dataset.folder)]
    shown = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert "measured" in shown
    assert "true" not in shown
