"""People and an object that move before a still room, as they are drawn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

from inhand_tracker.geometry.camera import Intrinsics

from inhand_lab.geometry.canvas import Canvas
from inhand_lab.geometry.surfaces import Surface, join_surfaces
from inhand_lab.geometry.transforms import Transform
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.person_surface import PersonSurface

KEPT_FRAMES = 3
"""Number of frames whose surfaces are kept: blur takes those before and after, which are drawn
themselves one frame earlier and later."""


@dataclass(frozen=True)
class MovingScene:
    """What is drawn over T frames, in the camera's frame.

    ``room`` is the room as drawn alone; ``people`` are the surface and the movement of each person,
    and ``camera_from_object`` is a series of T transforms.
    """

    room: Canvas
    intrinsics: Intrinsics
    people: tuple[tuple[PersonSurface, BodyMotion], ...]
    object_surface: Surface
    camera_from_object: Transform

    @property
    def frames(self) -> int:
        """Number of frames T."""
        return len(self.people[0][1].joints)

    def person(self, frame: int) -> Surface:
        """The surface of all people in a frame."""
        return self._person(frame)

    def object(self, frame: int) -> Surface:
        """The object's surface in a frame."""
        return self._object(frame)

    @cached_property
    def _person(self) -> Callable[[int], Surface]:
        def drawn(frame: int) -> Surface:
            posed = [surface.posed(body, frame) for surface, body in self.people]
            return posed[0] if len(posed) == 1 else join_surfaces(posed)

        return lru_cache(KEPT_FRAMES)(drawn)

    @cached_property
    def _object(self) -> Callable[[int], Surface]:
        surface, placed = self.object_surface, self.camera_from_object
        return lru_cache(KEPT_FRAMES)(lambda frame: surface.moved(placed[frame]))
