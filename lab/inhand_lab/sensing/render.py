"""Frames of a simulated scene as a perfect sensor would see them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Flags
from inhand_tracker.geometry.camera import Intrinsics

from inhand_lab.geometry.canvas import Canvas, draw_triangles
from inhand_lab.geometry.surfaces import Surface, surface_of_mesh
from inhand_lab.geometry.transforms import Transform
from inhand_lab.geometry.window import Window, window_around
from inhand_lab.objects.model import ObjectModel
from inhand_lab.sensing.moving_scene import MovingScene

ROOM, PERSON, OBJECT = 1, 2, 3
"""Labels of pixels; 0 is nothing."""


@dataclass(frozen=True)
class Drawing:
    """A frame as a perfect sensor would see it.

    ``visible_fraction`` is the share of the object's pixels that nothing hides, 0 where the object
    is out of the image; the canvas's labels are ROOM, PERSON and OBJECT. Outside the window
    ``drawn`` the canvas is the room alone.
    """

    canvas: Canvas
    visible_fraction: float
    drawn: Window

    @property
    def object_mask(self) -> Flags:
        """Pixels (H, W) that show the object."""
        return np.equal(self.canvas.labels, OBJECT)


def draw_room(intrinsics: Intrinsics, camera_from_world: Transform, room: Surface) -> Canvas:
    """Draw the room alone, once for all frames of a camera that stands still."""
    canvas = Canvas.blank(intrinsics)
    _draw_surface(canvas, intrinsics, room.moved(camera_from_world), ROOM)
    return canvas


def draw_frame(scene: MovingScene, frame: int) -> Drawing:
    """Draw a frame of person and object before the room."""
    canvas = scene.room.copy()
    person, placed = scene.person(frame), scene.object(frame)
    _draw_surface(canvas, scene.intrinsics, person, PERSON)
    _draw_surface(canvas, scene.intrinsics, placed, OBJECT)
    window = window_around(scene.intrinsics, placed.vertices)
    drawn = window_around(scene.intrinsics, np.concatenate([person.vertices, placed.vertices]))
    return Drawing(canvas, _share_seen(window.cut(canvas), window, placed), drawn)


def visible_fraction(scene: MovingScene, frame: int) -> float:
    """The visible fraction of ``draw_frame``; only the object's surroundings are drawn for it."""
    placed = scene.object(frame)
    window = window_around(scene.intrinsics, placed.vertices)
    canvas = window.cut(scene.room).copy()
    _draw_silhouette(canvas, window.intrinsics, scene.person(frame), PERSON)
    _draw_silhouette(canvas, window.intrinsics, placed, OBJECT)
    return _share_seen(canvas, window, placed)


def object_surface(model: ObjectModel) -> Surface:
    """The object's surface in the object's frame, ready to be moved and drawn."""
    return surface_of_mesh(model.mesh, model.vertex_colours)


def _draw_surface(canvas: Canvas, intrinsics: Intrinsics, surface: Surface, label: int) -> None:
    """Draw a surface that is in the camera's frame."""
    draw_triangles(
        canvas,
        intrinsics,
        surface.corners,
        surface.faces,
        surface.shades,
        label,
    )


def _draw_silhouette(canvas: Canvas, intrinsics: Intrinsics, surface: Surface, label: int) -> None:
    """Draw a surface without light, for what it hides and not for how it looks."""
    draw_triangles(canvas, intrinsics, surface.corners, surface.faces, surface.colours, label)


def _share_seen(canvas: Canvas, window: Window, placed: Surface) -> float:
    """Share of the object's pixels in a window that are its own on the canvas; 0 of none."""
    alone = Canvas.blank(window.intrinsics)
    _draw_silhouette(alone, window.intrinsics, placed, OBJECT)
    whole = int(np.count_nonzero(alone.labels))
    visible = int(np.count_nonzero(canvas.labels == OBJECT))
    return visible / whole if whole else 0.0
