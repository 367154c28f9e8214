import numpy as np
import pytest
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.sight.parameters import DEFAULT_SIGHT
from inhand_tracker.sight.silhouette import (
    interior,
    object_shares,
    pixels_covered,
    region_around,
    silhouette_depths,
    weights_of_sides,
)
from sights import EXTENTS, box

CAMERA = Intrinsics(100.0, 100.0, 31.5, 23.5, 64, 48)
UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
AHEAD = np.array([0.0, 0.0, 1.0 + EXTENTS[2] / 2.0])
"""The box's front is 1 m before the camera."""


def test_a_box_ahead_is_a_rectangle_as_far_away_as_its_front() -> None:
    depths = silhouette_depths(box(), AHEAD, UPRIGHT, CAMERA)
    seen = np.isfinite(depths)
    assert depths.shape == (48, 64)
    assert seen.any(axis=0).sum() == pytest.approx(100.0 * EXTENTS[0], abs=1.5)
    assert seen.any(axis=1).sum() == pytest.approx(100.0 * EXTENTS[1], abs=1.5)
    assert depths[24, 32] == pytest.approx(1.0)


def test_shares_add_up_to_the_area_that_an_object_covers() -> None:
    shifts = np.random.default_rng(0).uniform(-0.01, 0.01, (40, 2))
    areas = [
        object_shares(box(), AHEAD + np.array([*shift, 0.0]), UPRIGHT, CAMERA).sum()
        for shift in shifts
    ]
    assert np.mean(areas) == pytest.approx(1e4 * EXTENTS[0] * EXTENTS[1], rel=0.02)


def test_shares_go_from_all_in_the_middle_to_none_beside_it() -> None:
    shares = object_shares(box(), AHEAD, UPRIGHT, CAMERA)
    assert shares[24, 32] == 1.0
    assert shares[24, 32 + 8] == 0.0
    assert ((shares > 0.1) & (shares < 0.9)).sum() > 20


def test_the_rest_of_a_mixed_pixel_is_the_surroundings_in_the_ratio_of_both_areas() -> None:
    shares = np.array([[0.0, 0.0, 0.0, 0.0, 0.0, 0.25, 0.5, 1.0, 1.0, 1.0]], np.float32)
    hidden, beside = np.zeros(shares.shape, bool), np.zeros(shares.shape, bool)
    hidden[0, 9], beside[0, :4] = True, True
    of_object, around = weights_of_sides(shares, hidden, beside)
    np.testing.assert_allclose(of_object[0, 5:], [0.25, 0.5, 1.0, 1.0, 0.0])
    np.testing.assert_allclose(around[0, :5], [1.0, 1.0, 1.0, 1.0, 0.0])
    # Of 4 pixels of surroundings and 2.75 of the object, half a pixel is as much of either.
    assert around[0, 6] / around[0, :4].sum() == pytest.approx(of_object[0, 6] / of_object.sum())
    assert around[0, 7:].sum() == 0.0


def test_a_region_holds_the_object_with_surroundings_of_half_its_size() -> None:
    region = region_around(box(), AHEAD, UPRIGHT, CAMERA, DEFAULT_SIGHT)
    assert region is not None
    left, top, right, bottom = region
    margin = max(50.0 * np.sqrt(EXTENTS[0] * EXTENTS[1]), 8.0)
    assert (right - left) / 2.0 == pytest.approx(50.0 * EXTENTS[0] + margin)
    assert (bottom - top) / 2.0 == pytest.approx(50.0 * EXTENTS[1] + margin)


@pytest.mark.parametrize("place", [(9.0, 0.0, 1.0), (0.0, 0.0, -1.0), (0.0, 0.0, 0.05)])
def test_an_object_out_of_the_image_has_no_region(place: tuple[float, float, float]) -> None:
    assert region_around(box(), np.array(place), UPRIGHT, CAMERA, DEFAULT_SIGHT) is None


def test_only_what_is_well_before_the_surface_covers_it() -> None:
    depths = np.full((48, 64), 1.0)
    measured = np.full((48, 64), 0.9, np.float32)
    measured[:, :10], measured[:, 10:20] = 0.0, 0.97
    covered = pixels_covered(measured, depths, DEFAULT_SIGHT.aside_m)
    assert not covered[:, :20].any()
    assert covered[:, 20:].all()
    assert not pixels_covered(None, depths, DEFAULT_SIGHT.aside_m).any()


def test_an_interior_has_no_rim_unless_that_is_all_there_is() -> None:
    thick, thin = np.zeros((2, 9, 9), bool)
    thick[2:7, 2:7] = True
    thin[4] = True
    assert interior(thick).sum() == 9
    np.testing.assert_array_equal(interior(thin), thin)
