"""The depth likelihood against walls and boxes whose distances are known."""

import numpy as np
import pytest
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.methods.darby2014.depths import MeasuredSurfaces, depth_log_weights
from inhand_tracker.methods.darby2014.parameters import DEFAULT_SURFACE

FARTHEST_M = DEFAULT_SURFACE.farthest_surface_m
CAMERA = Intrinsics(300.0, 300.0, 159.5, 119.5, 320, 240)


def wall(distance: float = 2.0) -> np.ndarray:
    return np.full((240, 320), distance, np.float32)


def distances(depth: np.ndarray, *points: tuple[float, float, float]) -> np.ndarray:
    return MeasuredSurfaces(depth, CAMERA).distances(np.array([points]))[0]


@pytest.mark.parametrize("off", [-0.04, -0.02, 0.0, 0.03])
def test_a_point_before_or_behind_a_wall_is_as_far_away_as_that(off: float) -> None:
    (distance,) = distances(wall(), (0.1, 0.05, 2.0 + off))
    # A measured pixel in three is kept, 2 cm apart: 1.4 cm is the farthest from one of them.
    assert abs(off) - 1e-6 <= distance <= np.hypot(off, 0.0143)


def test_points_far_from_every_surface_are_all_alike() -> None:
    near, far = distances(wall(), (0.0, 0.0, 1.9), (0.0, 0.0, 0.5))
    assert near == far == FARTHEST_M


def test_the_nearest_surface_need_not_be_along_the_ray() -> None:
    depth = wall(3.0)
    depth[:, 160:] = 2.0  # a box's left side: x > 0 at 2 m
    beside, on = distances(depth, (-0.02, 0.0, 2.0), (0.02, 0.0, 2.0))
    assert 0.02 <= beside < 0.045
    assert on < 0.0143


def test_where_nothing_was_measured_nothing_is_known() -> None:
    depth = wall()
    depth[:, :160] = 0.0
    unknown, known = distances(depth, (-0.2, 0.0, 2.0), (0.2, 0.0, 2.0))
    assert np.isnan(unknown)
    assert known < 0.02


@pytest.mark.parametrize(
    "point",
    [(9.0, 0.0, 2.0), (0.0, -9.0, 2.0), (0.0, 0.0, -2.0), (0.0, 0.0, 0.0), (np.nan, 0.0, 2.0)],
)
def test_outside_the_image_and_behind_the_camera_nothing_is_known(
    point: tuple[float, float, float],
) -> None:
    assert np.isnan(distances(wall(), point)).all()


def test_an_image_without_any_measurement_knows_nothing() -> None:
    assert np.isnan(distances(wall(0.0), (0.0, 0.0, 2.0), (0.1, 0.0, 1.0))).all()


def test_sigma_is_the_mean_of_squared_shares_of_the_farthest() -> None:
    given = FARTHEST_M * np.array([[0.0, 1.0], [0.5, 0.5]])
    np.testing.assert_allclose(depth_log_weights(given), [-0.5, -0.25])


def test_unknown_points_speak_neither_for_nor_against() -> None:
    given = FARTHEST_M * np.array([[0.0, 0.0], [1.0, 1.0], [np.nan, np.nan]])
    good, bad, unknown = depth_log_weights(given)
    assert bad < unknown < good
    assert unknown == pytest.approx((good + bad) / 2)


def test_when_nothing_is_known_all_weigh_the_same() -> None:
    np.testing.assert_array_equal(depth_log_weights(np.full((3, 4), np.nan)), np.zeros(3))
