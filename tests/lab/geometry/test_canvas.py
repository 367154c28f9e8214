"""Triangles are painted where they are, the nearest in front."""

import cv2
import numpy as np
import pytest
import trimesh
from inhand_lab.geometry.canvas import NEAREST_PAINTED_M, Canvas, draw_triangles
from inhand_lab.geometry.surfaces import Surface, ellipsoid, limb
from inhand_lab.geometry.transforms import Transform
from inhand_lab.sensing.cameras import CAMERAS
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.shape.raster import nearest_depths

CAMERA = Intrinsics(60.0, 60.0, 23.5, 23.5, 48, 48)
KINECT = CAMERAS["kinect"].intrinsics
RED, BLUE = (200, 0, 0), (0, 0, 200)


def painted(vertices: np.ndarray, faces: np.ndarray, canvas: Canvas | None = None) -> Canvas:
    canvas = Canvas.blank(CAMERA) if canvas is None else canvas
    shades = np.full((len(vertices), 3), 200.0, np.float32)
    draw_triangles(canvas, CAMERA, vertices.astype("f4"), faces.astype("i4"), shades, 7)
    return canvas


def ball(distance: float) -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.creation.icosphere(3, 0.2)
    return mesh.vertices + np.array([0.0, 0.0, distance]), np.asarray(mesh.faces)


def test_depths_are_those_of_the_trackers_raster() -> None:
    vertices, faces = ball(1.0)
    canvas = painted(vertices, faces)
    depths = nearest_depths(CAMERA.project(vertices), vertices[:, 2], faces, (48, 48))
    shown = canvas.inverse_depth > 0.0
    assert shown.sum() > 400
    # The raster's lines add pixels along the rim, and it knows no perspective within a face.
    assert np.isfinite(depths[shown]).all()
    np.testing.assert_allclose(1.0 / canvas.inverse_depth[shown], depths[shown], atol=0.03)
    assert np.median(np.abs(1.0 / canvas.inverse_depth[shown] - depths[shown])) < 1e-3
    np.testing.assert_array_equal(canvas.labels, 7 * shown)
    millimetres = canvas.depth_in_millimetres()[shown]
    np.testing.assert_allclose(millimetres, 1000.0 / canvas.inverse_depth[shown], atol=0.51)


def test_what_faces_away_or_is_hidden_is_not_painted() -> None:
    vertices, faces = ball(1.0)
    near = painted(vertices, faces)
    farther = painted(*ball(2.0), near.copy())
    np.testing.assert_array_equal(farther.inverse_depth, near.inverse_depth)
    triangle = vertices[faces[np.argmin(vertices[faces].mean(axis=1)[:, 2])]]
    assert painted(triangle, np.array([[0, 1, 2]])).labels.any()
    assert not painted(triangle, np.array([[2, 1, 0]])).labels.any()


@pytest.mark.parametrize(("distance", "is_painted"), [(0.99, False), (1.01, True)])
def test_a_triangle_too_near_is_left_out(distance: float, is_painted: bool) -> None:
    corners = np.array([[-0.05, -0.05, 1.0], [0.0, 0.05, 1.0], [0.05, -0.05, 1.0]])
    canvas = painted(distance * NEAREST_PAINTED_M * corners, np.array([[0, 1, 2]]))
    assert canvas.labels.any() == is_painted


def drawn(*surfaces: Surface) -> Canvas:
    canvas = Canvas.blank(KINECT)
    for label, surface in enumerate(surfaces, start=1):
        vertices = surface.vertices.astype(np.float32)
        draw_triangles(canvas, KINECT, vertices, surface.faces, surface.colours, label)
    return canvas


def test_depth_is_the_distance_along_the_optical_axis() -> None:
    ball = ellipsoid((0.5, 0.2, 2.0), (0.2, 0.2, 0.2), RED, detail=4)
    depth = drawn(ball).depth_in_millimetres()
    column, row = 525 * 0.5 / 2.0 + 319.5, 525 * 0.2 / 2.0 + 239.5
    ray = np.array([(round(column) - 319.5) / 525, (round(row) - 239.5) / 525, 1.0])
    along = np.dot(ray, (0.5, 0.2, 2.0))
    expected = (along - np.sqrt(along**2 - ray @ ray * (4.29 - 0.04))) / (ray @ ray)
    assert depth[round(row), round(column)] == pytest.approx(1000 * expected, abs=1.0)
    assert depth[0, 0] == 0


@pytest.mark.parametrize("order", [1, -1])
def test_the_nearer_surface_hides_the_further_in_any_order(order: int) -> None:
    near = ellipsoid((0.0, 0.0, 1.5), (0.1, 0.1, 0.1), RED)
    far = ellipsoid((0.0, 0.0, 2.5), (0.4, 0.4, 0.1), BLUE)
    colour = drawn(*[near, far][::order]).colour
    assert tuple(colour[240, 320]) == RED
    assert tuple(colour[240, 365]) == BLUE


def test_what_is_behind_or_beside_the_camera_leaves_no_trace() -> None:
    behind = ellipsoid((0.0, 0.0, -2.0), (0.3, 0.3, 0.3), RED)
    beside = ellipsoid((9.0, 0.0, 2.0), (0.3, 0.3, 0.3), RED)
    above = ellipsoid((0.0, -9.0, 2.0), (0.3, 0.3, 0.3), RED)
    assert not drawn(behind, beside, above).labels.any()


def test_solids_are_drawn_without_holes() -> None:
    turned = Transform(np.array([-0.4, 0.0, 2.0]), np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]]))
    mask = drawn(limb(0.8, 0.1, 0.05, RED).moved(turned)).labels > 0
    outline, _ = cv2.findContours(mask.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    assert len(outline) == 1
    assert mask[240].sum() == pytest.approx(525 * 0.95 / 2.0, rel=0.03)
