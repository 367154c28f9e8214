"""A person and an object that move before a still room, as they are drawn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

from inhand_tracker.geometry.camera import Intrinsics

from inhand_lab.geometry.canvas import Canvas
from inhand_lab.geometry.surfaces import Surface
from inhand_lab.geometry.transforms import Transform
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.person_surface import PersonSurface

KEPT_FRAMES = 3
"""Number of frames whose surfaces are kept: blur takes those before and after, which are drawn
themselves one frame earlier and later."""


@dataclass(frozen=True)
class MovingScene:
    """What is drawn over T frames, in the camera's frame.

    ``room`` is the room as drawn alone; ``camera_from_object`` is a series of T transforms.
    """

    room: Canvas
    intrinsics: Intrinsics
    person_surface: PersonSurface
    body_in_camera: BodyMotion
    object_surface: Surface
    camera_from_object: Transform

    @property
    def frames(self) -> int:
        """Number of frames T."""
        return len(self.body_in_camera.joints)

    def person(self, frame: int) -> Surface:
        """The person's surface in a frame."""
        return self._person(frame)

    def object(self, frame: int) -> Surface:
        """The object's surface in a frame."""
        return self._object(frame)

    @cached_property
    def _person(self) -> Callable[[int], Surface]:
        surface, body = self.person_surface, self.body_in_camera
        return lru_cache(KEPT_FRAMES)(lambda frame: surface.posed(body, frame))

    @cached_property
    def _object(self) -> Callable[[int], Surface]:
        surface, placed = self.object_surface, self.camera_from_object
        return lru_cache(KEPT_FRAMES)(lambda frame: surface.moved(placed[frame]))
