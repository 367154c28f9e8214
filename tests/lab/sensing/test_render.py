"""Pictures of a scene: what hides what, and how far it is."""

import numpy as np
import pytest
from inhand_lab.sensing.cameras import CAMERAS
from inhand_lab.sensing.render import OBJECT, PERSON, Drawing
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.simulation import simulate
from silhouettes import silhouette

KINECT = CAMERAS["kinect"].intrinsics


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
