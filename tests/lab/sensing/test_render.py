"""Pictures: what is drawn where."""

import cv2
import numpy as np
import pytest
from inhand_lab.geometry.canvas import Canvas, draw_triangles
from inhand_lab.geometry.surfaces import Surface, ellipsoid, limb
from inhand_lab.geometry.transforms import Transform
from inhand_lab.sensing.cameras import CAMERAS
from inhand_lab.sensing.render import OBJECT, PERSON, Drawing
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.simulation import simulate
from silhouettes import silhouette

KINECT = CAMERAS["kinect"].intrinsics

RED, BLUE = (200, 0, 0), (0, 0, 200)


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


@pytest.mark.parametrize("interaction", INTERACTIONS)
def test_the_drawn_object_covers_what_its_projection_covers(interaction: str) -> None:
    for participant in range(3):
        simulation = simulate(interaction, participant, seed=5, frames=1)
        drawing = simulation.draw(0)
        if drawing.visible_fraction < 1.0:
            continue
        expected, found = silhouette(simulation, 0), drawing.object_mask
        overlap = np.count_nonzero(expected & found) / np.count_nonzero(expected | found)
        assert overlap >= 0.95


def in_use(drawing: Drawing) -> bool:
    return 0.0 < drawing.visible_fraction < 1.0


@pytest.mark.parametrize("interaction", INTERACTIONS)
def test_hands_and_head_hide_a_part_of_the_object(interaction: str) -> None:
    simulation = simulate(interaction, 1, seed=5)
    drawings = [simulation.draw(frame) for frame in range(100, 200, 20)]
    assert any(in_use(drawing) for drawing in drawings)
    for drawing in drawings:
        person, thing = (np.count_nonzero(drawing.canvas.labels == k) for k in (PERSON, OBJECT))
        assert person > 8000
        assert thing > 0


@pytest.mark.parametrize("interaction", INTERACTIONS)
def test_the_depth_of_the_object_is_its_geometry(interaction: str) -> None:
    simulation = simulate(interaction, 2, seed=5, frames=1)
    drawing = simulation.draw(0)
    depth = drawing.canvas.depth_in_millimetres()[drawing.object_mask] / 1000.0
    pose = simulation.camera_from_object[0]
    z = simulation.object_model.vertices @ pose.rotation[2] + pose.translation[2]
    assert depth.min() >= z.min() - 1e-3
    assert depth.max() <= z.max() + 1e-3
