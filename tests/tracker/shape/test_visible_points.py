from functools import lru_cache

import numpy as np
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.shape.viewpoints import Viewpoints, find_viewpoints
from inhand_tracker.shape.visible_points import VisiblePoints
from people import quaternion_of, wedge
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

CAMERA = Intrinsics(500.0, 500.0, 320.0, 240.0, 640, 480)


@lru_cache(maxsize=1)
def wedge_views() -> Viewpoints:
    return find_viewpoints(wedge())


def project(
    views: Viewpoints, translations: np.ndarray, orientations: np.ndarray, camera: Intrinsics
) -> np.ndarray:
    """Pixels of the boundaries of object poses."""
    seen = VisiblePoints(views.directions, views.boundaries)
    return camera.project(seen.place(translations, orientations))


def test_points_are_those_of_the_nearest_direction_turned_and_moved() -> None:
    directions, random = np.concatenate((np.eye(3), -np.eye(3))), np.random.default_rng(0)
    points, turns = random.normal(size=(6, 4, 3)), Rotation.random(30, rng=random)
    places = random.normal([0.0, 0.0, 2.0], 0.3, (30, 3))
    placed = VisiblePoints(directions, points).place(places, quaternion_of(turns))
    for turn, place, found in zip(turns, places, placed, strict=True):
        view = np.argmax(directions @ turn.inv().apply(-place))
        np.testing.assert_allclose(found, turn.apply(points[view]) + place)


def test_projected_boundaries_lie_on_the_silhouette_in_the_image() -> None:
    shape, views = wedge(), wedge_views()
    random = np.random.default_rng(4)
    turns = Rotation.random(40, rng=random)
    shifts = random.uniform([-0.4, -0.3, 1.5], [0.4, 0.3, 3.0], (40, 3))
    pixels = project(views, shifts, quaternion_of(turns), CAMERA)
    assert pixels.shape == (40, views.boundaries.shape[1], 2)
    for turn, shift, points in zip(turns, shifts, pixels, strict=True):
        placed = turn.apply(shape.vertices) + shift
        outline = placed[:, :2] / placed[:, 2:] * 500.0 + [320.0, 240.0]
        hull = ConvexHull(outline)
        outside = points @ hull.equations[:, :2].T + hull.equations[:, 2]
        size = np.ptp(outline, axis=0).max()
        assert np.abs(outside.max(axis=1)).max() < 1.0 + 0.06 * size
        assert np.abs(outside.max(axis=1)).mean() < 0.5 + 0.02 * size


def test_the_viewers_side_is_projected_whatever_the_quaternions_sign() -> None:
    views = wedge_views()
    turn = quaternion_of(Rotation.from_rotvec([0.3, 0.2, 0.1]))
    both = np.array([turn, -turn])
    pixels = project(views, np.tile([0.1, 0.0, 2.0], (2, 1)), both, CAMERA)
    np.testing.assert_allclose(pixels[0], pixels[1])


def test_objects_behind_the_camera_or_on_it_have_no_pixels() -> None:
    views = wedge_views()
    upright = np.tile([1.0, 0.0, 0.0, 0.0], (2, 1))
    pixels = project(views, np.array([[0.0, 0.0, -2.0], [0.0, 0.0, 0.0]]), upright, CAMERA)
    assert np.isnan(pixels[0]).all()
    assert np.isnan(pixels[1]).any()
