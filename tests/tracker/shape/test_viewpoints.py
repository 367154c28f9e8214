"""Boundaries against analytic silhouettes: circles of spheres, convex hulls of boxes."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
import trimesh
from inhand_tracker.shape.parameters import DEFAULT_SHAPE
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import (
    Viewpoints,
    count_views,
    find_surfaces,
    find_viewpoints,
)
from people import wedge
from scipy.spatial import ConvexHull
from scipy.spatial.distance import cdist

BOUNDARY_POINTS = DEFAULT_SHAPE.boundary_points
FEWER = replace(DEFAULT_SHAPE, subdivisions=2)
"""A quarter of the directions, 162: each is seen as it is by default."""


def shape_of(mesh: trimesh.Trimesh) -> ObjectShape:
    vertices = np.asarray(mesh.vertices, float)
    faces = np.asarray(mesh.faces, np.int64)
    return ObjectShape("thing", vertices, faces, vertices[:3], np.array([1.0, 0.0, 0.0]))


@lru_cache(maxsize=8)
def views_of(name: str) -> tuple[ObjectShape, Viewpoints]:
    meshes = {
        "sphere": lambda: trimesh.creation.icosphere(3, 0.1),
        "box": lambda: trimesh.creation.box((0.1, 0.2, 0.3)),
        "ring": lambda: trimesh.creation.torus(0.1, 0.03, 64, 32),
        "rod": lambda: trimesh.creation.cylinder(0.002, 1.1),
        "needle": lambda: trimesh.creation.cylinder(0.0004, 1.0),
        "sheet": lambda: trimesh.Trimesh(
            [[0, 0, 0], [0.1, 0, 0], [0.1, 0.2, 0], [0, 0.2, 0]], [[0, 1, 2], [0, 2, 3]]
        ),
    }
    shape = wedge() if name == "wedge" else shape_of(meshes[name]())
    return shape, find_viewpoints(shape, FEWER)


def flat(direction: np.ndarray) -> np.ndarray:
    """Two axes (2, 3) across a direction."""
    return np.linalg.svd(direction[None])[2][1:]


def pixel_of(shape: ObjectShape) -> float:
    """The largest size of one pixel of the raster, in metres, over all views."""
    diagonal = np.linalg.norm(np.ptp(shape.vertices, axis=0))
    return float(diagonal / (DEFAULT_SHAPE.boundary_raster - 1 - 2 * DEFAULT_SHAPE.boundary_margin))


def test_directions_go_all_around() -> None:
    coarse = replace(DEFAULT_SHAPE, boundary_raster=20, contour_raster=24)
    views = find_viewpoints(views_of("box")[0], coarse)
    assert views.directions.shape == (642, 3)
    assert views.boundaries.shape == (642, 50, 3)
    np.testing.assert_allclose(np.linalg.norm(views.directions, axis=1), 1.0)
    asked = np.random.default_rng(0).normal(size=(500, 3))
    asked /= np.linalg.norm(asked, axis=1, keepdims=True)
    nearest = np.arccos(np.clip((asked @ views.directions.T).max(axis=1), -1, 1))
    assert np.rad2deg(nearest).max() < 6.0


def test_each_view_that_is_drawn_is_reported_before_the_next() -> None:
    coarse = replace(DEFAULT_SHAPE, subdivisions=1, boundary_raster=20, contour_raster=24)
    reports: list[None] = []
    views = find_viewpoints(views_of("box")[0], coarse, lambda: reports.append(None))
    assert len(reports) == count_views(coarse) == 2 * len(views.directions)


def test_the_boundary_of_a_sphere_is_the_circle_across_the_view() -> None:
    shape, views = views_of("sphere")
    for direction, points in zip(views.directions[::4], views.boundaries[::4], strict=True):
        across = points @ flat(direction).T
        radii = np.linalg.norm(across, axis=1)
        assert radii.max() < 0.1 + 1.0 * pixel_of(shape)
        assert radii.min() > 0.1 - 1.5 * pixel_of(shape)
        angles = np.sort(np.arctan2(across[:, 1], across[:, 0]))
        gaps = np.diff(np.append(angles, angles[0] + 2 * np.pi))
        np.testing.assert_allclose(gaps, 2 * np.pi / BOUNDARY_POINTS, rtol=0.25)


def test_boundary_points_lie_on_the_side_that_is_seen() -> None:
    _, views = views_of("sphere")
    for direction, points in zip(views.directions[::4], views.boundaries[::4], strict=True):
        np.testing.assert_allclose(np.linalg.norm(points, axis=1), 0.1, rtol=0.03)
        towards_viewer = points @ direction
        assert towards_viewer.min() > -0.015
        assert np.median(towards_viewer) > 0.0


@pytest.mark.parametrize("name", ["box", "wedge"])
def test_the_boundary_of_a_convex_object_is_the_hull_of_its_corners(name: str) -> None:
    shape, views = views_of(name)
    for direction, points in zip(views.directions, views.boundaries, strict=True):
        axes = flat(direction)
        hull = ConvexHull(shape.vertices @ axes.T)
        # Signed distances to each side, negative inside.
        outside = (points @ axes.T) @ hull.equations[:, :2].T + hull.equations[:, 2]
        assert outside.max() < 1.0 * pixel_of(shape)
        assert outside.max(axis=1).min() > -1.6 * pixel_of(shape)


def test_points_are_equally_spaced_along_the_boundary_of_a_box() -> None:
    shape, views = views_of("box")
    straight_on = int(np.argmax(views.directions @ [0.0, 0.0, 1.0]))
    axes = flat(views.directions[straight_on])
    across = views.boundaries[straight_on] @ axes.T
    steps = np.linalg.norm(np.diff(across, axis=0, append=across[:1]), axis=1)
    hull = ConvexHull(shape.vertices @ axes.T)
    expected = hull.area / BOUNDARY_POINTS  # a hull's area in the plane is its perimeter
    # Corners cut steps short.
    assert np.median(steps) == pytest.approx(expected, rel=0.08)
    assert steps.max() < 1.2 * expected
    assert (steps > 0.65 * expected).all()


def test_the_hole_of_a_ring_has_a_boundary_too() -> None:
    shape, views = views_of("ring")
    through = int(np.argmax(views.directions @ [0.0, 0.0, 1.0]))
    across = views.boundaries[through] @ flat(views.directions[through]).T
    radii = np.linalg.norm(across, axis=1)
    inner = radii < 0.1
    tolerance = 2.5 * pixel_of(shape)
    np.testing.assert_allclose(radii[~inner], 0.13, atol=tolerance)
    np.testing.assert_allclose(radii[inner], 0.07, atol=tolerance)
    # Points are shared out by length: 7 of 20.
    assert inner.sum() == pytest.approx(BOUNDARY_POINTS * 0.07 / 0.20, abs=1.5)


def test_boundary_points_of_holes_lie_on_the_object() -> None:
    _, views = views_of("ring")
    for points in views.boundaries[::2]:
        from_circle = np.hypot(np.hypot(points[:, 0], points[:, 1]) - 0.1, points[:, 2])
        np.testing.assert_allclose(from_circle, 0.03, atol=0.01)


@pytest.mark.parametrize("name", ["rod", "needle"])
def test_the_boundary_of_a_thin_rod_runs_along_all_of_it(name: str) -> None:
    shape, views = views_of(name)
    length = np.ptp(shape.vertices[:, 2])
    aside = np.abs(views.directions[:, 2]) < 0.9
    along = np.sort(views.boundaries[aside][..., 2], axis=1)
    ends = np.full((len(along), 1), length / 2)
    gaps = np.diff(np.concatenate((-ends, along, ends), axis=1), axis=1)
    # Two sides of 25 points each, and a pixel of the raster.
    assert gaps.max() < 2 * length / 25 + 2 * pixel_of(shape)


def test_a_sheet_seen_edge_on_is_a_line() -> None:
    shape, views = views_of("sheet")
    for direction, points in zip(views.directions, views.boundaries, strict=True):
        if abs(direction[2]) > 1e-6:
            continue
        along = np.cross(direction, [0.0, 0.0, 1.0])
        assert np.ptp(points @ along) > 0.9 * np.ptp(shape.vertices @ along)


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_the_boundary_scales_with_the_object(scale: float) -> None:
    shape = wedge()
    grown = ObjectShape(
        "wedge", scale * shape.vertices, shape.faces, shape.marked_vertices, shape.mirror_normal
    )
    for few, many in zip(
        views_of("wedge")[1].boundaries[::2],
        find_viewpoints(grown, FEWER).boundaries[::2],
        strict=True,
    ):
        far = cdist(scale * few, many).min(axis=1)
        # Where the walk around begins may differ by rounding: half a spacing of some 10 mm.
        assert far.max() < 0.012 * scale


def test_a_mesh_of_one_point_gives_that_point() -> None:
    point = np.tile([0.1, 0.2, 0.3], (3, 1))
    shape = ObjectShape("dot", point, np.array([[0, 1, 2]]), point, np.array([1.0, 0, 0]))
    boundaries = find_viewpoints(shape, FEWER).boundaries
    assert boundaries.shape == (162, BOUNDARY_POINTS, 3)
    np.testing.assert_allclose(boundaries, np.broadcast_to(point[0], boundaries.shape))


# --- Surfaces


@pytest.mark.parametrize("name", ["sphere", "ring", "box", "wedge", "rod", "sheet"])
def test_surface_points_lie_on_the_mesh(name: str) -> None:
    shape, views = views_of(name)
    assert views.surfaces is not None
    assert views.surfaces.shape == (162, DEFAULT_SHAPE.surface_points, 3)
    mesh = trimesh.Trimesh(shape.vertices, shape.faces)
    dense = trimesh.sample.sample_surface(mesh, 40_000, seed=0)[0]
    away = cdist(views.surfaces[::20].reshape(-1, 3), dense).min(axis=1)
    assert away.max() < 2.5 * pixel_of(shape)


def test_surface_points_of_a_sphere_face_the_viewer() -> None:
    _, views = views_of("sphere")
    towards = np.einsum("vsi,vi->vs", views.surfaces, views.directions)
    assert towards.min() > -0.01
    # A point evenly drawn from a disc of radius r has the mean height 2/3 r on its half sphere.
    assert towards.mean() == pytest.approx(0.2 / 3, rel=0.03)


def test_of_a_ring_s_far_side_nothing_is_taken_that_its_near_side_hides() -> None:
    _, views = views_of("ring")
    edge_on = int(np.argmax(views.directions @ [1.0, 0.0, 0.0]))
    assert (views.surfaces[edge_on] @ views.directions[edge_on]).min() > 0.0


def test_surface_points_are_spread_evenly_over_what_is_seen() -> None:
    _, views = views_of("box")
    straight_on = int(np.argmax(views.directions @ [0.0, 0.0, 1.0]))
    across = views.surfaces[straight_on][:, :2]
    quadrants = [np.sum((np.sign(across) == s).all(axis=1)) for s in ((1, 1), (1, -1), (-1, 1))]
    assert min(quadrants) >= 9
    gaps = cdist(across, across) + np.eye(len(across))
    assert gaps.min(axis=1).min() > 0.004
    assert gaps.min(axis=1).max() < 0.03


def test_surfaces_can_be_found_for_the_directions_of_an_old_model() -> None:
    shape, views = views_of("wedge")
    np.testing.assert_array_equal(find_surfaces(shape, views.directions, FEWER), views.surfaces)
