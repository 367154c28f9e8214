"""A room to be in: floor, wall, and the clutter of somebody's home; it stands still."""

from __future__ import annotations

import numpy as np

from inhand_lab.geometry.surfaces import Rgb, Surface, block, join_surfaces
from inhand_lab.geometry.transforms import Transform, rotation_about
from inhand_lab.motions.furniture import Furniture

HALF_WIDTH = 4.0
BEHIND = 1.1
"""The back wall is this far behind the person, in metres, or somewhat more."""
WALL_HEIGHT = 2.7
TILE = 0.12
UPRIGHT = np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
"""Turns the plane z = 0, seen from above, into the plane y = 0, seen from the front."""


def build_room(random: np.random.Generator, facing: float, furniture: Furniture) -> Surface:
    """The room's surface in the person's world.

    facing is the direction to the camera as a turn to the left of the person's y axis, radians;
    the back wall is square to it. furniture is what the person uses.
    """
    wall = -BEHIND - random.uniform(0.0, 0.7)
    floor = _patches(random, (-HALF_WIDTH, wall), (HALF_WIDTH, 4.5))
    back = _patches(random, (-HALF_WIDTH, 0.0), (HALF_WIDTH, WALL_HEIGHT))
    raised = Transform(np.array([0.0, wall, 0.0]), UPRIGHT)
    pieces = [floor, back.moved(raised), *_pictures(random, wall), *_clutter(random, wall)]
    turned = Transform(np.zeros(3), rotation_about("z", facing))
    room = join_surfaces(pieces).moved(turned)
    return join_surfaces([room, *(block(box.centre, box.size, box.colour) for box in furniture)])


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
