"""Vessels of known volumes."""

import numpy as np
from inhand_outcomes.arrays import Array, Indices
from inhand_outcomes.thing import Thing

RADIUS, HEIGHT, WALL = 0.04, 0.10, 0.004
"""Of the inside of a round cup, and its wall, metres; its bottom is at z = 0."""
VOLUME_ML = np.pi * RADIUS**2 * HEIGHT * 1e6


def turned(outline: list[tuple[float, float]], sides: int = 40) -> tuple[Array, Indices]:
    """Vertices and faces of a surface that radii and heights make about z."""
    angles = 2.0 * np.pi * np.arange(sides) / sides
    ring = np.stack([np.cos(angles), np.sin(angles), np.zeros(sides)], axis=1)
    vertices = np.concatenate([ring * radius + [0.0, 0.0, z] for radius, z in outline])
    side = np.arange(sides)
    faces = []
    for low in range(len(outline) - 1):
        a, b = low * sides + side, low * sides + (side + 1) % sides
        faces += [np.stack([a, b, b + sides], axis=1), np.stack([a, b + sides, a + sides], axis=1)]
    return vertices, np.concatenate(faces)


def round_cup() -> tuple[Array, Indices]:
    """A cup with a wall, open above."""
    outer = RADIUS + WALL
    return turned(
        [(0, -WALL), (outer, -WALL), (outer, HEIGHT), (RADIUS, HEIGHT), (RADIUS, 0), (0, 0)]
    )


def with_box(mesh: tuple[Array, Indices], low: Array, high: Array) -> tuple[Array, Indices]:
    """A mesh and a box beside it, as another part."""
    vertices, faces = mesh
    corners = np.array([[(low, high)[b >> i & 1][i] for i in range(3)] for b in range(8)])
    quads = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    box = [three for a, b, c, d in quads for three in ((a, b, c), (a, c, d))]
    return np.concatenate([vertices, corners]), np.concatenate(
        [faces, np.array(box) + len(vertices)]
    )


def mug() -> Thing:
    """The round cup with a handle towards +y."""
    low, high = np.array([-0.005, 0.043, 0.02]), np.array([0.005, 0.075, 0.08])
    vertices, faces = with_box(round_cup(), low, high)
    return Thing("mug", "drinking", vertices, faces)


MUG = mug()
