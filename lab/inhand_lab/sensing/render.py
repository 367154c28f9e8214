"""Frames of a simulated scene: the still room behind the person and the object."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Flags
from inhand_tracker.geometry.camera import Intrinsics

from inhand_lab.geometry.rasteriser import Canvas, draw_triangles
from inhand_lab.geometry.surfaces import Surface, from_mesh, lit
from inhand_lab.geometry.transforms import Transform
from inhand_lab.geometry.window import Window, window_around
from inhand_lab.objects.model import ObjectModel
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.person_surface import PersonSurface

ROOM, PERSON, OBJECT = 1, 2, 3
"""Labels of pixels; 0 is nothing."""


@dataclass(frozen=True)
class Drawing:
    """A frame as a perfect sensor would see it.

    visible_fraction is the share of the object's pixels that nothing hides, 0 where the object is
    out of the image; the canvas's labels are ROOM, PERSON and OBJECT.
    """

    canvas: Canvas
    visible_fraction: float

    @property
    def object_mask(self) -> Flags:
        """Pixels (H, W) that show the object."""
        return np.equal(self.canvas.labels, OBJECT)


def draw_room(intrinsics: Intrinsics, camera_from_world: Transform, room: Surface) -> Canvas:
    """The room alone, to be drawn once for all frames of a camera that stands still."""
    canvas = Canvas.blank(intrinsics)
    _draw_surface(canvas, intrinsics, room.moved(camera_from_world), ROOM)
    return canvas


def draw_frame(
    room: Canvas,
    intrinsics: Intrinsics,
    figure: PersonSurface,
    body_in_camera: BodyMotion,
    frame: int,
    object_surface: Surface,
    camera_from_object: Transform,
) -> Drawing:
    """One frame: person and object, camera_from_object being one transform, before the room."""
    canvas = room.copy()
    _draw_surface(canvas, intrinsics, figure.posed(body_in_camera, frame), PERSON)
    placed = object_surface.moved(camera_from_object)
    _draw_surface(canvas, intrinsics, placed, OBJECT)
    window = window_around(intrinsics, placed.vertices)
    return Drawing(canvas, _share_seen(window.cut(canvas), window, placed))


def visible_fraction(
    room: Canvas,
    intrinsics: Intrinsics,
    figure: PersonSurface,
    body_in_camera: BodyMotion,
    frame: int,
    object_surface: Surface,
    camera_from_object: Transform,
) -> float:
    """What draw_frame would say, but only the part of the image that holds the object is drawn."""
    placed = object_surface.moved(camera_from_object)
    window = window_around(intrinsics, placed.vertices)
    canvas = window.cut(room).copy()
    _draw_silhouette(canvas, window.intrinsics, figure.posed(body_in_camera, frame), PERSON)
    _draw_silhouette(canvas, window.intrinsics, placed, OBJECT)
    return _share_seen(canvas, window, placed)


def object_surface(model: ObjectModel) -> Surface:
    """The object's surface in the object's frame, ready to be moved and drawn."""
    return from_mesh(model.mesh, model.vertex_colours)


def _draw_surface(canvas: Canvas, intrinsics: Intrinsics, surface: Surface, label: int) -> None:
    """Draw a surface that is in the camera's frame."""
    draw_triangles(
        canvas,
        intrinsics,
        surface.vertices.astype(np.float32),
        surface.faces,
        lit(surface.normals, surface.colours),
        label,
    )


def _draw_silhouette(canvas: Canvas, intrinsics: Intrinsics, surface: Surface, label: int) -> None:
    """Draw a surface without light: what it hides, and not how it looks."""
    vertices = surface.vertices.astype(np.float32)
    draw_triangles(canvas, intrinsics, vertices, surface.faces, surface.colours, label)


def _share_seen(canvas: Canvas, window: Window, placed: Surface) -> float:
    """The share of the object's pixels in a window that are its own on the canvas; 0 of none."""
    alone = Canvas.blank(window.intrinsics)
    _draw_silhouette(alone, window.intrinsics, placed, OBJECT)
    whole = int(np.count_nonzero(alone.labels))
    visible = int(np.count_nonzero(canvas.labels == OBJECT))
    return visible / whole if whole else 0.0
