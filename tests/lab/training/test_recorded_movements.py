"""What is read of people's recordings: whole bodies, and every so many-th movement."""

import numpy as np
import pytest
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.people.joint_sequence import JointSequence
from inhand_lab.training.parameters import DEFAULT_TRAINING
from inhand_lab.training.recorded_movements import read_movement, usual_poses
from inhand_tracker.body.skeleton import mirror_joints
from waving import waving

FRAMES = 40


def sequence(joints: np.ndarray, *, left_handed: bool = False) -> JointSequence:
    times_ns = np.arange(len(joints)) * 33_333_333
    return JointSequence("wave", "a", left_handed, joints, times_ns)


@pytest.fixture(scope="module")
def joints() -> np.ndarray:
    return waving(FRAMES, 0)[0]


def test_left_handed_people_are_read_mirrored(joints: np.ndarray) -> None:
    right = usual_poses([sequence(joints)])
    left = usual_poses([sequence(mirror_joints(joints), left_handed=True)])
    assert len(right.body_poses) == FRAMES // DEFAULT_TRAINING.usual_pose_step
    np.testing.assert_allclose(left.body_poses, right.body_poses, atol=1e-9)


def test_people_of_whom_no_whole_body_is_seen_are_passed_over(joints: np.ndarray) -> None:
    hidden = joints.copy()
    hidden[:, 7] = np.nan
    both = usual_poses([sequence(hidden), sequence(joints)])
    np.testing.assert_array_equal(both.body_poses, usual_poses([sequence(joints)]).body_poses)
    with pytest.raises(DatasetError, match="no recording shows a whole body"):
        usual_poses([sequence(hidden)])


def test_a_movement_is_read_in_every_so_many_th_frame_with_a_body(joints: np.ndarray) -> None:
    gap = joints.copy()
    gap[12] = np.nan
    usual = usual_poses([sequence(joints)])
    every, some = (read_movement(sequence(joints), usual, step) for step in (1, 4))
    np.testing.assert_array_equal(some.frames, np.arange(0, FRAMES, 4))
    np.testing.assert_array_equal(some.features, every.features[::4])
    assert 12 not in read_movement(sequence(gap), usual, 4).frames
