import numpy as np
import pytest
from inhand_tracker.geometry.motion import Motion
from inhand_tracker.geometry.placement import HERE, Placement
from people import quaternion_of, scipy_rotation
from scipy.spatial.transform import Rotation

TURN = Rotation.from_rotvec([0.3, -0.8, 0.5])
A_FROM_B = Placement(np.array([1.0, -2.0, 0.5]), quaternion_of(TURN))
B_FROM_C = Placement(np.array([0.2, 0.1, 3.0]), quaternion_of(Rotation.from_rotvec([0, 1, 0])))
POINT = np.array([0.4, 0.7, -1.1])


def test_points_and_poses_are_taken_from_one_frame_to_the_other() -> None:
    assert A_FROM_B.points(POINT) == pytest.approx(TURN.apply(POINT) + A_FROM_B.translation)
    place, turn = A_FROM_B.poses(POINT, B_FROM_C.rotation)
    assert place == pytest.approx(A_FROM_B.points(POINT))
    expected = TURN * scipy_rotation(B_FROM_C.rotation)
    assert (scipy_rotation(turn) * expected.inv()).magnitude() == pytest.approx(0.0, abs=1e-9)


def test_placements_chain_and_invert() -> None:
    chained = (A_FROM_B @ B_FROM_C).points(POINT)
    assert chained == pytest.approx(A_FROM_B.points(B_FROM_C.points(POINT)))
    assert (A_FROM_B.inverse() @ A_FROM_B).points(POINT) == pytest.approx(POINT)
    assert HERE.points(POINT) == pytest.approx(POINT)


@pytest.mark.parametrize("seconds", [0.02, -0.03, 0.0])
def test_an_even_motion_takes_an_object_where_it_goes(seconds: float) -> None:
    motion = Motion(POINT, np.array([1.0, 0.0, -0.5]), np.array([0.0, 3.0, 0.0]))
    moved = motion.placement(seconds)
    assert moved.points(POINT) == pytest.approx(POINT + seconds * motion.velocity)
    turned = scipy_rotation(moved.rotation).as_rotvec()
    assert turned == pytest.approx(seconds * motion.turning)
