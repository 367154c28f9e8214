"""A person and an object that move before a still room, as they are drawn."""

from __future__ import annotations

from dataclasses import dataclass

from inhand_tracker.geometry.camera import Intrinsics

from inhand_lab.geometry.canvas import Canvas
from inhand_lab.geometry.surfaces import Surface
from inhand_lab.geometry.transforms import Transform
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.person_surface import PersonSurface


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
        return self.person_surface.posed(self.body_in_camera, frame)

    def object(self, frame: int) -> Surface:
        """The object's surface in a frame."""
        return self.object_surface.moved(self.camera_from_object[frame])
