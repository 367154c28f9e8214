"""Draws images without noise as an ideal camera takes them: a pixel is the mean of what it covers.

The simulator's pictures take the colour at a pixel's centre. Here each pixel of an outline is mixed
of the object and of what is behind it, as real ones are, so that parts of a pixel count.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from inhand_tracker.geometry.arrays import Array, Singles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image

from inhand_lab.geometry.canvas import Canvas, draw_triangles
from inhand_lab.geometry.surfaces import Surface
from inhand_lab.geometry.transforms import Transform
from inhand_lab.world.room import RoomPlan, build_room
from inhand_lab.world.viewpoint import looking

_ROOM, _OBJECT = 1, 2
"""Labels of pixels."""


@dataclass(frozen=True)
class PerfectCamera:
    """A camera before a room: ``room`` is the room drawn ``finer`` times finer than the camera's
    pixels."""

    intrinsics: Intrinsics
    finer: int
    room: Canvas

    @classmethod
    def before_room(
        cls, intrinsics: Intrinsics, finer: int, position: Array, random: np.random.Generator
    ) -> PerfectCamera:
        """Stand at a ``position`` (3,) of a room drawn at random, and look at its back wall."""
        fine = _finer(intrinsics, finer)
        canvas = Canvas.blank(fine)
        ahead = position * np.array([1.0, 0.0, 1.0])
        surface = build_room(random, RoomPlan(0.0), ()).moved(looking(position, ahead))
        _draw(canvas, fine, surface, _ROOM)
        return cls(intrinsics, finer, canvas)

    def take(
        self, surface: Surface, camera_from_object: Transform, *, returns_depth: bool
    ) -> Image:
        """Take an image of an object's surface before the room; depth is what a pixel's centre
        shows, and none of an object that returns none."""
        fine = _finer(self.intrinsics, self.finer)
        canvas = self.room.copy()
        _draw(canvas, fine, surface.moved(camera_from_object), _OBJECT)
        size = self.intrinsics.width, self.intrinsics.height
        colour = cv2.resize(canvas.colour, size, interpolation=cv2.INTER_AREA)
        depth = self._depth(canvas, returns_depth)
        return Image(None, self.intrinsics, depth, np.asarray(colour, np.uint8))

    def _depth(self, canvas: Canvas, returns_depth: bool) -> Singles:
        """Depth (H, W) in metres at the pixels' centres, 0 where there is none."""
        centres = (slice(self.finer // 2, None, self.finer),) * 2
        inverse, labels = canvas.inverse_depth[centres], canvas.labels[centres]
        measured = (inverse > 0.0) & (returns_depth | (labels != _OBJECT))
        depth = np.zeros(inverse.shape, np.float32)
        depth[measured] = 1.0 / inverse[measured]
        return depth


def _finer(intrinsics: Intrinsics, times: int) -> Intrinsics:
    return intrinsics.scaled_to(times * intrinsics.width, times * intrinsics.height)


def _draw(canvas: Canvas, intrinsics: Intrinsics, surface: Surface, label: int) -> None:
    draw_triangles(canvas, intrinsics, surface.corners, surface.faces, surface.shades, label)
