"""A camera that records video."""

from __future__ import annotations

from functools import cache

import numpy as np
import trimesh
from trimesh import creation

from inhand_lab.objects.model import ObjectModel, build_model

CAMERA_WIDTH = 0.124
CAMERA_HEIGHT = 0.078
CAMERA_DEPTH = 0.046
LENS_RADIUS = 0.034
LENS_LENGTH = 0.065
GRIP_OFFSET = CAMERA_WIDTH / 2.0 - 0.008
"""Distance from the camera's middle to the middle of the side that a hand holds."""
BODY_COLOUR, LENS_COLOUR, GLASS_COLOUR = (44, 44, 48), (30, 30, 32), (84, 92, 128)
SCREEN_COLOUR = (70, 80, 92)
FORWARD = np.array([[1.0, 0, 0, 0], [0, 0, 1.0, 0], [0, -1.0, 0, 0], [0, 0, 0, 1.0]])
"""Homogeneous transform that lays the z axis along y."""


@cache
def camera() -> ObjectModel:
    """A camera looking along y with z up; the origin is the middle of its body."""
    wide, deep, high = CAMERA_WIDTH / 2.0, CAMERA_DEPTH / 2.0, CAMERA_HEIGHT / 2.0
    body = trimesh.convex.convex_hull(
        np.array(
            [
                (x * across, y * along, z * high)
                for across, along in ((wide, 0.55 * deep), (0.86 * wide, deep))
                for x in (-1.0, 1.0)
                for y in (-1.0, 1.0)
                for z in (-1.0, 1.0)
            ]
        )
    )
    finder = trimesh.convex.convex_hull(
        np.array(
            [
                (x * across, y * along, z)
                for across, along, z in ((0.030, deep, high), (0.018, 0.8 * deep, high + 0.022))
                for x in (-1.0, 1.0)
                for y in (-1.0, 1.0)
            ]
        )
    )
    barrel = _lens(LENS_RADIUS, deep - 0.002, deep + LENS_LENGTH)
    glass = _lens(LENS_RADIUS - 0.007, deep + LENS_LENGTH - 0.004, deep + LENS_LENGTH + 0.001)
    screen = creation.box(extents=(0.075, 0.003, 0.050))
    screen.apply_translation([0.0, -deep - 0.0005, -0.006])
    parts = [
        (body, BODY_COLOUR),
        (finder, BODY_COLOUR),
        (barrel, LENS_COLOUR),
        (glass, GLASS_COLOUR),
        (screen, SCREEN_COLOUR),
    ]
    return build_model("camera", parts, _marks(wide, deep, high))


def _lens(radius: float, back: float, front: float) -> trimesh.Trimesh:
    """A cylinder along y from y = back to y = front."""
    cylinder = creation.cylinder(radius=radius, height=front - back, sections=32)
    cylinder.apply_transform(FORWARD)
    cylinder.apply_translation([0.0, 0.5 * (front + back), 0.0])
    return cylinder


def _marks(wide: float, deep: float, high: float) -> list[tuple[float, float, float]]:
    """Corners of the front, top of the finder and edge of the lens, by the body's half sizes."""
    return [
        *((x * wide, 0.55 * deep, z * high) for x in (-1.0, 1.0) for z in (-1.0, 1.0)),
        (0.018, -0.8 * deep, high + 0.022),
        (-0.018, -0.8 * deep, high + 0.022),
        (LENS_RADIUS, deep + LENS_LENGTH, 0.0),
        (-LENS_RADIUS, deep + LENS_LENGTH, 0.0),
        (0.0, deep + LENS_LENGTH, -LENS_RADIUS),
    ]
