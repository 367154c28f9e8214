"""Where the head of a simulated person is in the picture, whatever a network says."""

import numpy as np
from inhand_lab.geometry.canvas import draw_triangles
from inhand_lab.people.person_surface import LIMB_SOLIDS
from inhand_lab.sensing.render import OBJECT, PERSON
from inhand_lab.world.simulation import Simulation
from numpy.typing import NDArray

HEAD_PART = len(LIMB_SOLIDS) + 2
"""The head's number among a person's parts: after limbs, pelvis and trunk."""
HEAD = 9


def head_pixels(simulation: Simulation, frame: int) -> NDArray[np.bool_]:
    """The pixels (H, W) that show some of the head, hair and ears included."""
    scene = simulation._scene
    canvas = scene.room.copy()
    person, lens = scene.person(frame), scene.intrinsics
    parts = np.concatenate([surface.part for surface, _ in scene.people])
    of_head = parts[person.faces[:, 0]] == HEAD_PART
    placed = scene.object(frame)
    for faces, label in ((person.faces[~of_head], PERSON), (person.faces[of_head], HEAD)):
        draw_triangles(canvas, lens, person.corners, faces, person.shades, label)
    draw_triangles(canvas, lens, placed.corners, placed.faces, placed.shades, OBJECT)
    return np.asarray(canvas.labels == HEAD)
