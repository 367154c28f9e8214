import numpy as np
import pytest
import trimesh
from inhand_lab.geometry.surface_distance import MeasuredSurface, mean_surface_distance

BOX = trimesh.creation.box(extents=(0.1, 0.2, 0.3))
SURFACE = MeasuredSurface(BOX.vertices, BOX.faces, samples=2000, neighbours=6)


def test_distances_are_those_from_the_nearest_triangle() -> None:
    points = np.array([(0.0, 0.0, 0.25), (0.08, 0.14, 0.0), (0.0, 0.09, 0.0)])
    expected = [0.1, np.hypot(0.03, 0.04), 0.01]
    np.testing.assert_allclose(SURFACE.distances(points), expected, atol=1e-6)


def test_points_lie_on_the_surface_and_are_the_same_each_time() -> None:
    again = MeasuredSurface(BOX.vertices, BOX.faces, samples=2000, neighbours=6)
    points = SURFACE.points(300)
    np.testing.assert_array_equal(points, again.points(300))
    assert SURFACE.distances(points).max() < 1e-9


def test_the_mean_distance_of_two_spheres_is_that_of_their_radii() -> None:
    spheres = [trimesh.creation.icosphere(subdivisions=3, radius=r) for r in (0.100, 0.105)]
    small, large = (MeasuredSurface(s.vertices, s.faces, 4000, 6) for s in spheres)
    assert mean_surface_distance(small, large, 500) == pytest.approx(0.005, abs=2e-4)
