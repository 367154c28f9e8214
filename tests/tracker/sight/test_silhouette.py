import numpy as np
import pytest
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.sight.parameters import DEFAULT_SIGHT
from inhand_tracker.sight.silhouette import (
    interior,
    pixels_covered,
    region_around,
    silhouette_depths,
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
