import numpy as np
import pytest
import trimesh
from inhand_lab.geometry.canvas import NEAREST_PAINTED_M, Canvas, draw_triangles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.shape.raster import nearest_depths

CAMERA = Intrinsics(60.0, 60.0, 23.5, 23.5, 48, 48)


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
    depths = nearest_depths(CAMERA.project(vertices), vertices[:, 2], faces, 48)
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
