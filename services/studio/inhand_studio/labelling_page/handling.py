"""The object of a desk is moved and turned, and its keyframes are set and taken away."""

from collections.abc import Mapping
from functools import partial

import numpy as np
from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.keyframes import LabellingError
from inhand_tracker.geometry.arrays import Array

from inhand_studio.labelling_page import editing as edits
from inhand_studio.labelling_page.desk import Desk
from inhand_studio.labelling_page.panel import Act
from inhand_studio.labelling_page.parameters import DEFAULT_PAGE
from inhand_studio.labelling_page.placing import dragged, moved, turned

X, Y, Z = np.eye(3)
STEPS = {"left": -X, "right": X, "up": -Y, "down": Y, "nearer": -Z, "farther": Z}
TURNS = {
    "pitch_up": X,
    "pitch_down": -X,
    "yaw_left": Y,
    "yaw_right": -Y,
    "roll_left": -Z,
    "roll_right": Z,
}


class Handling:
    """What a person does to the object of a desk by handles, keys and numbers."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._dragging: Pose | None = None

    def acts(self) -> Mapping[str, Act]:
        """Return what keys and buttons do to the object and its keyframes."""
        desk, page = self._desk, DEFAULT_PAGE
        acts: dict[str, Act] = {
            "type_pose": lambda: desk.set_pose(desk.panel.typed),
            "preview": lambda: desk.stage.move_object(desk.panel.typed),
            "choose_part": self._choose_part,
            "set_keyframe": lambda: desk.set_pose(desk.require_pose()),
            "delete_keyframe": self._delete,
            "mark_absent": lambda: desk.set_pose(None),
            "copy_previous": self._copy_previous,
            "undo": lambda: desk.edit(edits.undone),
            "redo": lambda: desk.edit(edits.redone),
        }
        for name, direction in STEPS.items():
            acts[name] = partial(self._step, direction, page.coarse_m)
            acts[f"fine_{name}"] = partial(self._step, direction, page.fine_m)
        for name, axis in TURNS.items():
            acts[name] = partial(self._turn, axis, page.coarse_deg)
            acts[f"fine_{name}"] = partial(self._turn, axis, page.fine_deg)
        return acts

    def drag(self, before: Pose, now: Pose, phase: str) -> None:
        """Follow the handles, which were at a pose before the drag; its end sets a keyframe."""
        desk = self._desk
        if self._dragging is None:
            self._dragging = desk.require_pose()
        pose = dragged(self._dragging, before, now)
        if phase == "end":
            self._dragging = None
            desk.set_pose(pose)
        else:
            desk.stage.move_object(pose)
            desk.panel.show_pose(pose)

    def _step(self, direction: Array, metres: float) -> None:
        desk = self._desk
        desk.set_pose(moved(desk.require_pose(), metres * direction, desk.axes()))

    def _turn(self, axis: Array, degrees: float) -> None:
        desk, turn = self._desk, np.deg2rad(degrees) * axis
        desk.set_pose(turned(desk.require_pose(), turn, desk.axes(), desk.middle()))

    def _delete(self) -> None:
        frame = self._desk.frame
        self._desk.edit(lambda editing: edits.without_keyframe(editing, frame))

    def _copy_previous(self) -> None:
        before = self._desk.editing.before(self._desk.frame)
        if before is None or before.pose is None:
            raise LabellingError("there is no pose in a keyframe before this frame")
        self._desk.set_pose(before.pose)

    def _choose_part(self) -> None:
        part, frame = self._desk.panel.part, self._desk.frame
        self._desk.edit(lambda editing: edits.relative_to(editing, part, frame))
