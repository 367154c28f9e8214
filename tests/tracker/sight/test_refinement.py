from dataclasses import replace

import kernel_arrays as arrays
import numpy as np
import pytest
from inhand_tracker.geometry import rotations
from inhand_tracker.sight.frame import SightFrame
from inhand_tracker.sight.parameters import DEFAULT_SIGHT
from inhand_tracker.sight.refinement import PosePrior, PoseRefiner
from inhand_tracker.sight.view import SightView
from sights import CAMERA

UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
PRIOR = PosePrior(np.array([0.1, 0.0, 1.0]), UPRIGHT, np.diag([400.0] * 3 + [25.0] * 3))


def off(metres: float, radians: float) -> tuple[np.ndarray, np.ndarray]:
    """A pose (1, 3), (1, 4) off the prior's along and about x."""
    place = PRIOR.translation + np.array([metres, 0.0, 0.0])
    return place[None], rotations.from_vector(np.array([[radians, 0.0, 0.0]]))


def test_reach_is_the_root_mean_square_in_metres_and_radians() -> None:
    assert PRIOR.reach() == pytest.approx((0.05 * 3**0.5, 0.2 * 3**0.5))


def test_reach_is_no_more_than_what_poses_are_known_to_be_off_by() -> None:
    assert replace(PRIOR, most=(0.05, 0.25)).reach() == pytest.approx((0.05, 0.25))
    assert replace(PRIOR, most=(0.5, 0.25)).reach() == pytest.approx((0.05 * 3**0.5, 0.25))


def test_log_density_falls_by_half_a_deviations_square() -> None:
    assert PRIOR.log_density(*off(0.0, 0.0)) == pytest.approx(0.0)
    assert PRIOR.log_density(*off(0.05, 0.0)) == pytest.approx(-0.5)
    assert PRIOR.log_density(*off(0.0, 0.4)) == pytest.approx(-2.0)


def empty_view() -> SightView:
    """A view of a frame of no colour and no depth."""
    size = (CAMERA.height, CAMERA.width)
    frame = SightFrame(CAMERA, None, None)
    return SightView(frame, np.zeros((*size, 2), np.float32), np.zeros(size, np.uint8))


@pytest.mark.parametrize("trust", [1.0, 0.1])
def test_a_pose_of_which_nothing_is_seen_stays_or_goes_to_its_prior(trust: float) -> None:
    refiner = PoseRefiner(
        arrays.outlines(), arrays.outlines(), np.ones(4, bool), 0.9, DEFAULT_SIGHT
    )
    start = off(0.03, 0.1)
    unmoved = refiner.refine(start, empty_view(), None, trust)
    np.testing.assert_array_equal(unmoved.translations, start[0])
    np.testing.assert_array_equal(unmoved.information, 0.0)
    moved = refiner.refine(start, empty_view(), PRIOR, trust)
    # Damping holds back a little at each step, and less with every one.
    np.testing.assert_allclose(moved.translations[0], PRIOR.translation, atol=1e-5)
    assert rotations.angle_between(moved.rotations[0], UPRIGHT) < 1e-4
