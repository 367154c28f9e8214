"""An object in 3-D beside a hand of the same scale, with its marks and axes of symmetry."""

from collections.abc import Iterator

import numpy as np
import viser
from inhand_lab.new_objects.description import describe_symmetry
from inhand_lab.new_objects.drawn_hand import HAND_BREADTH, HAND_LENGTH, open_hand
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import ObjectShape

from inhand_studio.scene_parts import UPRIGHT
from inhand_studio.visit import Visit

SEEN_FROM = rotations.rotate(UPRIGHT, np.array([0.75, 1.0, 0.55]))
"""Direction from which an object is seen at first: from ahead and above."""
DISTANCE = 2.2
"""Distance from which it is seen at first, in sizes of what is shown."""
STANDING = np.zeros(3), UPRIGHT
"""The pose in which an object is shown."""
GAP_M = 0.03
CLAY, SKIN, MARK, TURN = (120, 150, 196), (222, 178, 150), (240, 170, 0), (200, 40, 160)
MARK_SHARE, AXIS_SHARE = 0.02, 1.3
"""Radius of a mark, and length of an axis of symmetry, in the object's size."""


def show_object(visit: Visit, shape: ObjectShape) -> None:
    """Draw an object into a tab's scene, in place of what is there, and look at it."""
    scene = visit.client.scene
    size = float(np.ptp(shape.vertices, axis=0).max())
    scene.add_mesh_simple(
        "/shown/object",
        _turned(shape.vertices),
        shape.faces.astype(np.uint32),
        color=CLAY,
        flat_shading=True,
        side="double",
    )
    show_marks(visit, shape, shape.marked_vertices)
    _draw_axes(scene, shape, size)
    _draw_hand(scene, shape)
    _look(visit.client, max(size, HAND_LENGTH))


def show_marks(visit: Visit, shape: ObjectShape, marks: Array) -> None:
    """Draw marks (M, 3) on an object that is shown, in place of those that were."""
    scene = visit.client.scene
    size = float(np.ptp(shape.vertices, axis=0).max())
    scene.remove_by_name("/shown/marks")
    for number, mark in enumerate(marks):
        scene.add_icosphere(
            f"/shown/marks/{number}", MARK_SHARE * size, MARK, position=_turned(mark)
        )


def described(shape: ObjectShape) -> Iterator[str]:
    """Say how large an object is, and when it looks the same."""
    sides = " × ".join(f"{100.0 * side:.1f}" for side in np.ptp(shape.vertices, axis=0))
    yield f"{shape.name}: {sides} cm along x, y, z; {len(shape.faces):,} faces"
    yield f"{len(shape.marked_vertices)} marked vertices (yellow)"
    turns = [describe_symmetry(symmetry) for symmetry in shape.symmetries]
    yield "looks the same (pink axes): " + ("; ".join(turns) or "never when turned")


def _draw_axes(scene: viser.SceneApi, shape: ObjectShape, size: float) -> None:
    scene.add_frame("/shown/axes", axes_length=0.75 * size, axes_radius=0.006 * size, wxyz=UPRIGHT)
    ends = []
    for symmetry in shape.symmetries:
        half = 0.5 * AXIS_SHARE * size * np.array(symmetry.axis)
        ends.append(np.array(symmetry.centre) + np.stack((-half, half)))
    lines = _turned(np.array(ends)) if ends else np.zeros((0, 2, 3), np.float32)
    scene.add_line_segments("/shown/turns", lines, TURN, thickness=3.0, thickness_units="screen")


def _draw_hand(scene: viser.SceneApi, shape: ObjectShape) -> None:
    """Draw the hand at the side of the object, both standing on one plane."""
    hand = open_hand()
    lowest, side = shape.vertices[:, 2].min(), shape.vertices[:, 0].max()
    beside = np.array([side + GAP_M + 0.5 * HAND_BREADTH, 0.0, lowest - hand.vertices[:, 2].min()])
    scene.add_mesh_simple(
        "/shown/hand",
        _turned(hand.vertices + beside),
        hand.faces.astype(np.uint32),
        color=SKIN,
        side="double",
    )


def _look(client: viser.ClientHandle, size: float) -> None:
    towards = SEEN_FROM / np.linalg.norm(SEEN_FROM)
    centre = np.array([0.5 * HAND_BREADTH, 0.0, 0.0])
    with client.atomic():
        client.camera.position = centre + DISTANCE * size * towards
        client.camera.look_at = centre


def _turned(points: Array) -> Array:
    """Turn points (..., 3) of an object upright in the scene."""
    return np.asarray(rotations.rotate(UPRIGHT, points), np.float32)
