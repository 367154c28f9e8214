"""Moves what is drawn in a tab's scene: people and objects that come and go."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import viser
from inhand_schemas.messages import Person, Pose
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.wire.conversion import joints_of

from inhand_studio.scene_parts import BONE, TRACKED, Colour, add_bones, add_object, bones

PEOPLE: tuple[Colour, ...] = (BONE, (90, 200, 250), (200, 130, 250), (130, 230, 140))
"""Colours of the people of a frame, in turn."""
AXES_M = 0.1
"""Length in metres of the axes of an object without a mesh."""


@dataclass(frozen=True)
class PlacedObject:
    """An object to be drawn: ``slot`` tells it from all others that are drawn at a time."""

    slot: str
    shape: ObjectShape | None
    pose: Pose
    colour: Colour = TRACKED
    opacity: float = 0.7


class DrawnScene:
    """Draws people and objects into a tab's scene, and takes away what is no longer there."""

    def __init__(self, scene: viser.SceneApi) -> None:
        self._scene = scene
        self._objects: dict[str, tuple[PlacedObject, viser.SceneNodeHandle]] = {}
        self._people: dict[int, viser.LineSegmentsHandle] = {}

    def draw_people(self, people: Sequence[Person]) -> None:
        """Draw the bones of people in the camera frame whose both ends are known."""
        ends = {number: bones(joints_of(person)) for number, person in enumerate(people)}
        for number, parts in ends.items():
            if not len(parts):
                continue
            if (drawn := self._people.get(number)) is None:
                colour = PEOPLE[number % len(PEOPLE)]
                self._people[number] = add_bones(self._scene, f"/people/{number}", parts, colour)
            else:
                drawn.points, drawn.visible = parts, True
        for number, drawn in self._people.items():
            if not len(ends.get(number, ())):
                drawn.visible = False

    def draw_objects(self, placed: Iterable[PlacedObject]) -> None:
        """Draw objects, or the axes of those without a shape, at their poses camera_from_object."""
        absent = set(self._objects)
        for one in placed:
            absent.discard(one.slot)
            node = self._node(one)
            node.position, node.wxyz = np.array(one.pose.translation), np.array(one.pose.rotation)
            node.visible = True
        for slot in absent:
            self._objects[slot][1].visible = False

    def _node(self, placed: PlacedObject) -> viser.SceneNodeHandle:
        """Return what draws an object, made anew where its shape or look is another."""
        drawn = self._objects.get(placed.slot)
        if drawn is not None:
            before, node = drawn
            if before.shape is placed.shape and before.colour == placed.colour:
                return node
            node.remove()
        name = f"/objects/{placed.slot}"
        if placed.shape is None:
            node = self._scene.add_frame(name, axes_length=AXES_M, axes_radius=0.05 * AXES_M)
        else:
            node = add_object(self._scene, name, placed.shape, placed.colour, placed.opacity)
        self._objects[placed.slot] = placed, node
        return node
