"""Colour of what moves while the shutter is open.

Where something moves by a pixel or more its triangles are drawn again and again on their way, and
the pictures averaged. Everything else is as it was drawn, so that stillness costs nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_runtime.compiled import njit
from inhand_tracker.geometry.arrays import Array, Bytes, Flags, Singles
from inhand_tracker.geometry.camera import Intrinsics
from numpy.typing import NDArray

from inhand_lab.geometry.canvas import Canvas, draw_triangles
from inhand_lab.geometry.surfaces import Surface
from inhand_lab.geometry.window import window_around
from inhand_lab.sensing.moving_scene import MovingScene

SHARPNESS = 1.0
"""Movement during the exposure below which nothing is blurred, pixels."""
SPACING = 4.0
"""Distance between one averaged picture and the next, pixels."""
MOST_PICTURES = 8
"""Number of averaged pictures at the most; the faster movement, the farther they are apart."""


@dataclass(frozen=True)
class Moving:
    """A surface in the camera's frame in the middle of the exposure.

    ``travel`` (V, 3) is the way of each vertex in the course of it, metres.
    """

    surface: Surface
    travel: Array


def surfaces_in_motion(scene: MovingScene, frame: int, exposure: float) -> list[Moving]:
    """Person and object in a frame, moving as from the frame before to the frame after.

    ``exposure`` is a share of the time from frame to frame.
    """
    before, after = max(frame - 1, 0), min(frame + 1, scene.frames - 1)
    share = exposure / max(after - before, 1)
    return [
        Moving(middle, share * (end.vertices - start.vertices))
        for start, middle, end in (
            [surface(one) for one in (before, frame, after)]
            for surface in (scene.person, scene.object)
        )
    ]


def blurred(sharp: Canvas, room: Canvas, intrinsics: Intrinsics, moving: list[Moving]) -> Bytes:
    """Colours (H, W, 3) of moving surfaces that were drawn sharply before the room."""
    ways = [_way_in_pixels(one, intrinsics) for one in moving]
    furthest = max(float(way.max()) for way in ways)
    if furthest < SHARPNESS:
        return sharp.colour
    parts = [_Part.of(one, way) for one, way in zip(moving, ways, strict=True)]
    swept = [part.swept() for part in parts]
    window = window_around(intrinsics, np.concatenate(swept))
    if 0 in (window.intrinsics.width, window.intrinsics.height):
        return sharp.colour
    behind = window.cut(room).copy()
    for part in parts:
        part.draw(behind, window.intrinsics, ~part.moves, 0.0)
    count = int(np.clip(np.ceil(furthest / SPACING), 2, MOST_PICTURES))
    total = np.zeros(behind.colour.shape, np.uint16)
    for share in (np.arange(count) + 0.5) / count - 0.5:
        picture = behind.copy()
        for part in parts:
            part.draw(picture, window.intrinsics, part.moves, float(share))
        _add(total, picture.colour)
    colour = sharp.colour.copy()
    _divide(total, count, colour[window.rows, window.columns])
    return colour


def _way_in_pixels(moving: Moving, intrinsics: Intrinsics) -> Array:
    """How far each vertex (V,) goes across the image, pixels."""
    return np.asarray(_way(moving.surface.vertices, moving.travel, intrinsics.fx))


@dataclass(frozen=True)
class _Part:
    """A surface ready to be drawn: vertices and travel (V, 3); ``moves`` (F,) marks faces."""

    vertices: Singles
    travel: Singles
    faces: NDArray[np.int32]
    shades: Singles
    moves: Flags

    @classmethod
    def of(cls, moving: Moving, way: Array) -> _Part:
        surface = moving.surface
        return cls(
            surface.corners,
            moving.travel.astype(np.float32),
            surface.faces,
            surface.shades,
            np.asarray((way >= SHARPNESS)[surface.faces].any(axis=1)),
        )

    def swept(self) -> Singles:
        """Places (N, 3) at which the vertices of moving faces begin and end."""
        corners = np.zeros(len(self.vertices), bool)
        corners[self.faces[self.moves]] = True
        middle, half = self.vertices[corners], 0.5 * self.travel[corners]
        return np.concatenate([middle - half, middle + half])

    def draw(self, canvas: Canvas, intrinsics: Intrinsics, chosen: Flags, share: float) -> None:
        """Draw the chosen faces (F,) where they are at a share of the exposure, 0 its middle."""
        placed = self.vertices + np.float32(share) * self.travel
        draw_triangles(canvas, intrinsics, placed, self.faces[chosen], self.shades, 1)


@njit(cache=True, nogil=True)
def _way(vertices, travel, focal):  # type: ignore[no-untyped-def]
    way = np.empty(len(vertices))
    for vertex in range(len(vertices)):
        depth = max(vertices[vertex, 2], 0.1)
        forward = travel[vertex, 2] / depth
        across = travel[vertex, 0] - vertices[vertex, 0] * forward
        down = travel[vertex, 1] - vertices[vertex, 1] * forward
        way[vertex] = focal * np.sqrt(across * across + down * down) / depth
    return way


@njit(cache=True, nogil=True)
def _add(total, colour):  # type: ignore[no-untyped-def]
    height, width, _ = colour.shape
    for v in range(height):
        for u in range(width):
            for channel in range(3):
                total[v, u, channel] += colour[v, u, channel]


@njit(cache=True, nogil=True)
def _divide(total, count, colour):  # type: ignore[no-untyped-def]
    height, width, _ = colour.shape
    for v in range(height):
        for u in range(width):
            for channel in range(3):
                colour[v, u, channel] = (total[v, u, channel] + count // 2) // count
