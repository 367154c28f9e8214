"""A room to be in: floor, wall, and the clutter of somebody's home; it stands still."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.surfaces import Rgb, Surface, block, join_surfaces
from inhand_lab.geometry.transforms import Transform, rotation_about
from inhand_lab.motions.furniture import Furniture

HALF_WIDTH = 4.0
BEHIND = 1.1
"""The back wall is this far behind the person, in metres, or somewhat more."""
AHEAD = 4.5
"""The wall that the person faces is this far ahead, metres."""
WALL_HEIGHT = 2.7
CLUTTER_DEPTH = 0.75
"""Distance from the back wall, metres, within which its clutter may stand before a camera."""
FROM_A_WALL = 0.3
"""Distance of a camera from the other walls, at the least, metres."""
TILE = 0.12
UPRIGHT = np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
"""Turns the plane z = 0, seen from above, into the plane y = 0, seen from the front."""


@dataclass(frozen=True)
class RoomPlan:
    """How a room stands about a person.

    ``turn`` is the direction, as a turn to the left of the person's y axis in radians, that the
    back wall is square to: to the camera, or to a rig's first one. The wall is ``further`` metres
    behind the person than usual. An ``enclosed`` room has its other three walls as well, which
    cameras at a person's sides look at.
    """

    turn: float
    further: float = 0.0
    enclosed: bool = False


def build_room(random: np.random.Generator, plan: RoomPlan, furniture: Furniture) -> Surface:
    """The room's surface in the person's world; ``furniture`` is what the person uses.

    What a room has is the same whether it is enclosed or not.
    """
    wall = wall_place(random, plan)
    floor = _patches(random, (-HALF_WIDTH, wall), (HALF_WIDTH, AHEAD))
    back = _patches(random, (-HALF_WIDTH, 0.0), (HALF_WIDTH, WALL_HEIGHT))
    raised = Transform(np.array([0.0, wall, 0.0]), UPRIGHT)
    pieces = [floor, back.moved(raised), *_pictures(random, wall), *_clutter(random, wall)]
    if plan.enclosed:
        pieces += _other_walls(random)
    turned = Transform(np.zeros(3), rotation_about("z", plan.turn))
    room = join_surfaces(pieces).moved(turned)
    return join_surfaces([room, *(block(box.centre, box.size, box.colour) for box in furniture)])


def wall_place(random: np.random.Generator, plan: RoomPlan) -> float:
    """Where the back wall is along the room's y axis, metres: the first that a room draws."""
    return -BEHIND - random.uniform(0.0, 0.7) - plan.further


def in_the_open(plan: RoomPlan, wall: float, position: Array) -> bool:
    """Whether a camera at a position (3,) in the person's world is before all walls and clutter."""
    across, along, _ = rotation_about("z", plan.turn).T @ position
    return bool(
        wall + CLUTTER_DEPTH < along < AHEAD - FROM_A_WALL
        and abs(across) < HALF_WIDTH - FROM_A_WALL
    )


def _patches(
    random: np.random.Generator, near: tuple[float, float], far: tuple[float, float]
) -> Surface:
    """A rectangle in the plane z = 0, from corner to corner, of patches of differing shade."""
    across, along = (np.arange(*span, TILE) for span in zip(near, far, strict=True))
    corners = np.stack(np.meshgrid(across, along), axis=-1).reshape(-1, 1, 2)
    squares = corners + TILE * np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    count = len(squares)
    shades = np.array(_colour(random)) * (1.0 + 0.06 * random.normal(size=(count, 1)))
    faces = 4 * np.arange(count)[:, None, None] + np.array([(0, 1, 2), (0, 2, 3)])
    return Surface(
        np.concatenate([squares, np.zeros((count, 4, 1))], axis=2).reshape(-1, 3),
        np.tile([0.0, 0.0, 1.0], (4 * count, 1)),
        faces.reshape(-1, 3).astype(np.int32),
        np.repeat(np.clip(shades, 0.0, 255.0), 4, axis=0).astype(np.float32),
    )


def _other_walls(random: np.random.Generator) -> list[Surface]:
    """The walls at the person's sides and before the person, with pictures on them."""
    pieces = []
    for turn, distance, corner in (
        (0.5 * np.pi, HALF_WIDTH, AHEAD),
        (-0.5 * np.pi, HALF_WIDTH, AHEAD),
        (np.pi, AHEAD, HALF_WIDTH),
    ):
        patches = _patches(random, (-corner, 0.0), (corner, WALL_HEIGHT))
        raised = patches.moved(Transform(np.array([0.0, -distance, 0.0]), UPRIGHT))
        around = Transform(np.zeros(3), rotation_about("z", turn))
        pieces += [part.moved(around) for part in (raised, *_pictures(random, -distance))]
    return pieces


def _pictures(random: np.random.Generator, wall: float) -> list[Surface]:
    """Frames on the wall, each with a picture of a few blocks of colour."""
    pieces = []
    for _ in range(random.integers(3, 7)):
        x, z = random.uniform(-1.8, 1.8), random.uniform(1.3, 2.2)
        wide, high = random.uniform(0.2, 0.6, 2)
        pieces.append(block((x, wall, z), (wide, 0.03, high), _colour(random)))
        for _ in range(4):
            part = np.array([wide, high]) * random.uniform(0.15, 0.45, 2)
            place = np.array([x, z]) + (np.array([wide, high]) - part) * random.uniform(
                -0.5, 0.5, 2
            )
            centre, size = (place[0], wall + 0.01, place[1]), (part[0], 0.02, part[1])
            pieces.append(block(centre, size, _colour(random)))
    return pieces


def _clutter(random: np.random.Generator, wall: float) -> list[Surface]:
    """Cupboards and shelves along the wall with things standing on them."""
    pieces = []
    for x in np.arange(-2.2, 2.3, 0.7):
        if random.random() < 0.3:
            continue
        wide, deep, high = random.uniform((0.35, 0.25, 0.35), (0.65, 0.45, 1.3))
        centre = (x, wall + deep / 2.0, high / 2.0)
        pieces.append(block(centre, (wide, deep, high), _colour(random)))
        for place in x + wide * random.uniform(-0.4, 0.4, random.integers(1, 5)):
            size = random.uniform((0.04, 0.04, 0.06), (0.15, 0.15, 0.35))
            above = (place, wall + deep / 2.0, high + size[2] / 2.0)
            pieces.append(block(above, size, _colour(random)))
    return pieces


def _colour(random: np.random.Generator) -> Rgb:
    """Draw the colour of a muted paint or fabric."""
    shade = random.uniform(40.0, 210.0) + random.normal(0.0, 22.0, 3)
    red, green, blue = (int(value) for value in np.clip(shade, 15.0, 240.0))
    return red, green, blue
