"""Simulated depth of things on a table, with the simulator's sensor and its noise."""

from collections.abc import Sequence

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.canvas import Canvas, draw_triangles
from inhand_lab.geometry.surfaces import Surface, block, surface_of_mesh
from inhand_lab.geometry.transforms import Transform, normalised, rotation_about
from inhand_lab.objects.model import ObjectModel
from inhand_lab.sensing.cameras import KINECT, Camera
from inhand_lab.sensing.noise_fields import any_place
from inhand_lab.sensing.sensor import FrameConditions, sense
from inhand_lab.world.random_streams import random_stream

TABLE = (1.2, 0.8)
"""Width and depth of the table in metres."""
TABLE_HEIGHT = 0.74
WOOD, FLOOR, WALL = (146, 108, 70), (120, 118, 112), (206, 202, 190)
M_PER_MM = 0.001


def camera_above(distance: float, down: float, aside: float = 0.0) -> Transform:
    """The pose camera_from_table of a camera that looks at the middle of the table.

    It is ``distance`` metres away, looks ``down`` by an angle in radians, and stands ``aside`` by
    another, to the right of the table's -y side. The table is the plane z = 0.
    """
    ahead = rotation_about("z", aside) @ np.array([0.0, np.cos(down), -np.sin(down)])
    right = normalised(np.cross(ahead, [0.0, 0.0, 1.0]))
    rotation = np.array([right, np.cross(ahead, right), ahead])
    return Transform(rotation @ (distance * ahead), rotation)


def standing_at(model: ObjectModel, x: float, y: float, turn: float) -> Transform:
    """The pose table_from_object of a thing that stands upright at a place of the table."""
    lowest = float(model.vertices[:, 2].min())
    return Transform(np.array([x, y, -lowest]), rotation_about("z", turn))


def table_depths(
    things: Sequence[tuple[ObjectModel, Transform]],
    camera_from_table: Transform,
    seed: int,
    frames: int,
    camera: Camera = KINECT,
) -> Array:
    """Sense depths (T, H, W) in metres of things, each with its pose table_from_object."""
    random = random_stream(seed, 0, "table", "pixels")
    canvas = Canvas.blank(camera.intrinsics)
    surfaces = [*_room(), *(_surface(model).moved(pose) for model, pose in things)]
    for surface in surfaces:
        placed = surface.moved(camera_from_table)
        draw_triangles(
            canvas, camera.intrinsics, placed.corners, placed.faces, placed.shades, label=1
        )
    conditions = FrameConditions(lasting=any_place(random))
    sensed = [sense(canvas, camera, random, conditions)[1] for _ in range(frames)]
    return np.stack(sensed).astype(np.float64) * M_PER_MM


def _surface(model: ObjectModel) -> Surface:
    return surface_of_mesh(model.mesh, model.vertex_colours)


def _room() -> list[Surface]:
    """The table, the floor in small pieces, and a wall behind."""
    top = block((0.0, 0.0, -0.015), (*TABLE, 0.03), WOOD)
    tiles = [
        block((x, y, -TABLE_HEIGHT - 0.01), (0.5, 0.5, 0.02), FLOOR)
        for x in np.arange(-2.0, 2.1, 0.5)
        for y in np.arange(-0.5, 1.6, 0.5)
    ]
    walls = [block((x, 1.6, 0.3), (0.5, 0.02, 2.2), WALL) for x in np.arange(-2.0, 2.1, 0.5)]
    return [top, *tiles, *walls]
