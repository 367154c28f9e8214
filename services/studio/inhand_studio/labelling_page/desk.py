"""One object in one recording, as a person labels it in a tab."""

import time
from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.keyframes import Keyframe, KeyframeFile, LabellingError
from inhand_runtime.wording import counted
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import ObjectShape

from inhand_studio.labelling_page import editing as edits
from inhand_studio.labelling_page.autosave import KeptKeyframes, keyframes_path
from inhand_studio.labelling_page.opened import OpenedRecording
from inhand_studio.labelling_page.panel import OBJECT_FRAME, Act, Panel
from inhand_studio.labelling_page.parameters import DEFAULT_PAGE
from inhand_studio.labelling_page.placing import dragged, message_of, moved, turned
from inhand_studio.labelling_page.shown_pose import ShownPose, part_basis, shown_pose
from inhand_studio.labelling_page.stage import Look, Stage
from inhand_studio.labelling_page.strip import strip
from inhand_studio.visit import Visit

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


class Desk:
    """All that happens to the keyframes of one object in one recording."""

    def __init__(self, visit: Visit, recording: OpenedRecording, shape: ObjectShape) -> None:
        """Open the keyframes; raises LabellingError and RecordingError. The recording is closed
        with the desk."""
        self.visit, self.recording, self.shape = visit, recording, shape
        camera = recording.camera if recording.several_cameras else None
        empty = KeyframeFile(
            recording=recording.path.name,
            object=shape.name,
            camera=recording.camera,
            keyframes=(),
        )
        self.kept = KeptKeyframes(keyframes_path(recording.path, shape.name, camera), empty)
        try:
            self.editing = self.kept.load()
        except LabellingError:
            self.kept.close()
            raise
        self.frame = 0
        self._drawn = -1
        self._dragging: Pose | None = None
        self._playing: tuple[float, int] | None = None
        self._tried_s = time.monotonic()
        self.shown = ShownPose(None, "guess")
        self.stage = Stage(visit, recording, shape, self._drag)
        self.panel = Panel(visit, len(recording), self._acts())
        self.panel.show_part(self.editing.part)
        self.refresh()

    def close(self) -> None:
        """Let others edit, and close the recording."""
        self.kept.close()
        self.recording.close()

    # Looking.

    def go(self, frame: int) -> None:
        """Show a frame."""
        self.frame = int(np.clip(frame, 0, len(self.recording) - 1))
        self.refresh()

    def refresh(self) -> None:
        """Draw what is now."""
        if self._drawn != self.frame:
            self.stage.show_frame(self.frame)
            self._drawn = self.frame
        self.shown = self._find_shown()
        self.stage.show_object(self.shown.pose, self.shown.standing, self._axes())
        wanted = self.panel.shows_labels
        self.stage.show_label(self.recording.label(self.shape.name, self.frame) if wanted else None)
        self.panel.show_frame(self.frame)
        self.panel.show_pose(self.shown.pose)
        self.panel.show_strip(strip(self.editing.keyframes, len(self.recording), self.frame))
        self.show_status()

    def _find_shown(self) -> ShownPose:
        return shown_pose(self.editing, self.recording, self.frame, self.shape.symmetries)

    def show_status(self) -> None:
        """Say what frame and pose are shown, and how the keyframes stand."""
        self.panel.show_claimed(self.kept.claimed)
        self.panel.status.content = "\n\n".join(self._lines())

    def _lines(self) -> list[str]:
        seconds = (self.recording.times_ns[self.frame] - self.recording.times_ns[0]) / 1e9
        what = self.shown.standing + (f": {self.shown.note}" if self.shown.note else "")
        lines = [f"Frame **{self.frame}** of {len(self.recording)}, {seconds:.2f} s: **{what}**"]
        count = counted(len(self.editing.keyframes), "keyframe")
        if not self.kept.claimed:
            lines.insert(0, "**Read only: another tab or studio labels this object here.**")
        elif self.kept.trouble is not None:
            lines.insert(0, f"# NOT SAVED\n\n**{self.kept.trouble}** It is tried again by itself.")
        else:
            lines.append(f"{count}, saved in {self.kept.path.name}")
        return [*lines, *self.recording.notes]

    def tick(self) -> None:
        """Do what time asks for: play, write again what could not be written, look at others."""
        if self._playing is not None:
            started_s, first = self._playing
            times_ns = self.recording.times_ns
            until_ns = times_ns[first] + round(1e9 * (time.monotonic() - started_s))
            frame = int(np.searchsorted(times_ns, until_ns, side="right")) - 1
            if frame >= len(times_ns) - 1:
                self.play()
            if frame != self.frame:
                self.go(frame)
        if time.monotonic() - self._tried_s > DEFAULT_PAGE.retry_s:
            self._tried_s = time.monotonic()
            self._look_at_disk()

    def _look_at_disk(self) -> None:
        if self.kept.claimed:
            if self.editing.unsaved:
                self.editing = self.kept.save(self.editing)
                self.show_status()
        elif (now := self.kept.load()).keyframes != self.editing.keyframes:
            self.editing = now
            self.refresh()
        else:
            self.show_status()

    @property
    def playing(self) -> bool:
        return self._playing is not None

    def play(self) -> None:
        """Play from this frame on, or stop."""
        if self._playing is None and self.frame >= len(self.recording) - 1:
            self.go(0)
        self._playing = None if self._playing else (time.monotonic(), self.frame)
        self.panel.show_playing(self.playing)

    def _jump(self, keyframe: Keyframe | None) -> None:
        if keyframe is not None:
            self.go(keyframe.frame)

    def _scrub(self) -> None:
        if self.panel.frame != self.frame:
            self._playing = None
            self.panel.show_playing(False)
            self.go(self.panel.frame)

    def _zoom(self) -> None:
        middle = None if self.stage.zoomed else self._middle()
        self.stage.zoom(middle)

    def _look(self, look: Look) -> None:
        self.stage.look(look, self._middle())
        self._drawn = -1
        self.refresh()

    def _middle(self) -> Array:
        pose = self.shown.pose
        return np.array([0.0, 0.0, 2.0]) if pose is None else self.stage.middle_of(pose)

    # Editing.

    def edit(self, change: Callable[[edits.Editing], edits.Editing]) -> None:
        """Change the keyframes, and write them at once."""
        if not self.kept.claimed:
            self.refresh()
            raise LabellingError(
                "this is read only, as another tab or studio labels this object here: press "
                "“Take over” first"
            )
        if self.recording.unlabelled_because is not None:
            self.refresh()
            raise LabellingError(self.recording.unlabelled_because)
        told = self.kept.trouble
        self.editing = change(self.editing)
        self.editing = self.kept.save(self.editing)
        self.panel.show_part(self.editing.part)
        self.refresh()
        if self.kept.trouble is not None and told is None:
            self.visit.tell(self.kept.trouble, title="Keyframes are NOT SAVED")

    def set_pose(self, pose: Pose | None) -> None:
        """Set the keyframe of this frame; None marks the object as absent."""
        keyframe = Keyframe(
            frame=self.frame,
            time_ns=int(self.recording.times_ns[self.frame]),
            camera_from_object=None if pose is None else message_of(pose),
            relative_to=None if pose is None else self.editing.part,
        )
        self.edit(lambda editing: edits.with_keyframe(editing, keyframe))

    def require_pose(self) -> Pose:
        """Return the pose that is shown; raises LabellingError where the object is absent."""
        if self.shown.pose is None:
            raise LabellingError("the object is absent here: delete the keyframe that says so")
        return self.shown.pose

    def _axes(self) -> Array:
        """Return along which axes (4,) the object is moved."""
        name = self.panel.axes
        if name == OBJECT_FRAME and self.shown.pose is not None:
            return self.shown.pose[1]
        part = None if name in (OBJECT_FRAME, "camera") else name
        return part_basis(part, self.recording, self.frame)[1]

    def _step(self, direction: Array, metres: float) -> None:
        self.set_pose(moved(self.require_pose(), metres * direction, self._axes()))

    def _turn(self, axis: Array, degrees: float) -> None:
        turn = np.deg2rad(degrees) * axis
        self.set_pose(turned(self.require_pose(), turn, self._axes(), self._middle()))

    def _drag(self, before: Pose, now: Pose, phase: str) -> None:
        if phase == "start" or self._dragging is None:
            self._dragging = self.require_pose()
        pose = dragged(self._dragging, before, now)
        if phase == "end":
            self._dragging = None
            self.set_pose(pose)
        else:
            self.stage.move_object(pose)
            self.panel.show_pose(pose)

    def _type_pose(self) -> None:
        self.set_pose((self.panel.place_m, self.panel.rotation))

    def _copy_previous(self) -> None:
        before = self.editing.before(self.frame)
        if before is None or before.pose is None:
            raise LabellingError("there is no pose in a keyframe before this frame")
        self.set_pose(before.pose)

    def _choose_part(self) -> None:
        part, frame = self.panel.part, self.frame
        self.edit(lambda editing: edits.relative_to(editing, part, frame))

    def _take_over(self) -> None:
        self.kept.take_over()
        self.editing = self.kept.load()
        self.refresh()

    def _acts(self) -> Mapping[str, Act]:
        page = DEFAULT_PAGE
        acts: dict[str, Act] = {
            "scrub": self._scrub,
            "back": lambda: self.go(self.frame - 1),
            "on": lambda: self.go(self.frame + 1),
            "back_ten": lambda: self.go(self.frame - 10),
            "on_ten": lambda: self.go(self.frame + 10),
            "first": lambda: self.go(0),
            "last": lambda: self.go(len(self.recording) - 1),
            "previous_keyframe": lambda: self._jump(self.editing.before(self.frame)),
            "next_keyframe": lambda: self._jump(self.editing.after(self.frame)),
            "play": self.play,
            "look_colour": lambda: self._look("colour"),
            "look_depth": lambda: self._look("depth"),
            "look_3d": lambda: self._look("3-D"),
            "zoom": self._zoom,
            "redraw": self.refresh,
            "type_pose": self._type_pose,
            "choose_part": self._choose_part,
            "set_keyframe": lambda: self.set_pose(self.require_pose()),
            "delete_keyframe": lambda: self.edit(
                lambda editing: edits.without_keyframe(editing, self.frame)
            ),
            "mark_absent": lambda: self.set_pose(None),
            "copy_previous": self._copy_previous,
            "undo": lambda: self.edit(edits.undone),
            "redo": lambda: self.edit(edits.redone),
            "take_over": self._take_over,
        }
        for name, direction in STEPS.items():
            acts[name] = partial(self._step, direction, page.coarse_m)
            acts[f"fine_{name}"] = partial(self._step, direction, page.fine_m)
        for name, axis in TURNS.items():
            acts[name] = partial(self._turn, axis, page.coarse_deg)
            acts[f"fine_{name}"] = partial(self._turn, axis, page.fine_deg)
        return acts
