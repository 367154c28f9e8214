"""One object in one recording, as a person labels it in a tab."""

import time
from collections.abc import Callable, Mapping

import numpy as np
from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.keyframes import Keyframe, KeyframeFile, LabellingError
from inhand_runtime.wording import counted
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.image import Image
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.wire.poses import pose_message

from inhand_studio.labelling_page import editing as edits
from inhand_studio.labelling_page.assistant import Assistance
from inhand_studio.labelling_page.autosave import KeptKeyframes, keyframes_path
from inhand_studio.labelling_page.background import Background
from inhand_studio.labelling_page.opened import OpenedRecording
from inhand_studio.labelling_page.panel import CAMERA_FRAME, OBJECT_FRAME, Act, Panel
from inhand_studio.labelling_page.parameters import DEFAULT_PAGE
from inhand_studio.labelling_page.shown_pose import ShownPose, part_basis, shown_pose
from inhand_studio.labelling_page.stage import Look, Stage
from inhand_studio.labelling_page.strip import strip
from inhand_studio.player import Player
from inhand_studio.visit import Visit


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
            self._check_keyframes()
        except LabellingError:
            self.kept.close()
            raise
        self.frame = 0
        self._drawn = -1
        self._player = Player(recording.times_ns)
        self._tried_s = time.monotonic()
        self.shown = ShownPose(None, "guess")
        self.background = Background(visit)
        self.assistance: Assistance | None = None

    def _check_keyframes(self) -> None:
        """Raise LabellingError where keyframes are of another recording of that name."""
        times_ns = self.recording.times_ns
        for one in self.editing.keyframes:
            if one.frame >= len(times_ns) or one.time_ns != times_ns[one.frame]:
                raise LabellingError(
                    f"{self.kept.path} has a keyframe of frame {one.frame} at {one.time_ns}, which "
                    "this recording does not have: it is of another one; move the file away"
                )

    def begin(self, stage: Stage, panel: Panel) -> None:
        """Show all on a stage and a panel."""
        self.stage, self.panel = stage, panel
        panel.show_part(self.editing.part)
        self.refresh()

    def close(self) -> None:
        """Let others edit, end what runs, and close the recording."""
        self.background.close()
        self.kept.close()
        self.recording.close()

    # Looking.

    def go(self, frame: int) -> None:
        """Show a frame, and play no longer."""
        self._player.jump(frame)
        self._show(self._player.frame(time.monotonic()))

    def _show(self, frame: int) -> None:
        self.frame = frame
        self.panel.show_playing(self.playing)
        self.refresh()

    def refresh(self) -> None:
        """Draw what is now."""
        if self._drawn != self.frame:
            self.stage.show_frame(self.frame)
            self._drawn = self.frame
        self.shown = self._find_shown()
        self.stage.show_object(self.shown.pose, self.shown.standing, self.axes())
        wanted = self.panel.shows_labels
        self.stage.show_label(self.recording.label(self.shape.name, self.frame) if wanted else None)
        self.panel.show_frame(self.frame)
        self.panel.show_pose(self.shown.pose)
        doubts = None if self.assistance is None else self.assistance.found.doubts
        keyframes, frames = self.editing.keyframes, len(self.recording)
        self.panel.show_strip(strip(keyframes, frames, self.frame, doubts))
        self.show_status()

    def _find_shown(self) -> ShownPose:
        shown = shown_pose(self.editing, self.recording, self.frame, self.shape.symmetries)
        if self.assistance is not None:
            shown = self.assistance.improve(shown, self.editing, self.frame)
        return shown

    def axes(self) -> Array:
        """Return along which axes (4,) the object is moved."""
        name = self.panel.axes
        if name == OBJECT_FRAME and self.shown.pose is not None:
            return self.shown.pose[1]
        part = None if name in (OBJECT_FRAME, CAMERA_FRAME) else name
        return part_basis(part, self.recording, self.frame)[1]

    def ask(self, text: str) -> None:
        """Say what is to be done next, or what was done."""
        self.panel.said.content = text

    def take_assistance(self, assistance: Assistance) -> None:
        """Show refined poses from now on."""
        self.assistance = assistance
        worst = assistance.worst(self.editing)
        self.refresh()
        if worst is not None:
            doubt = 100 * assistance.found.doubts[worst]
            self.ask(f"Refined. Least sure is frame {worst}: it may be {doubt:.1f} cm off.")

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
        self.panel.show_progress(self.background.doing, self.background.share)
        if self.playing and (frame := self._player.frame(time.monotonic())) != self.frame:
            self._show(frame)
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
        """Whether frames are shown one after another, as they were taken."""
        return self._player.playing

    def play(self) -> None:
        """Play from this frame on, or stop."""
        now = time.monotonic()
        if self.playing:
            self._player.stop(now)
        else:
            self._player.play(1.0, now)
        self._show(self._player.frame(now))

    def _jump(self, keyframe: Keyframe | None) -> None:
        if keyframe is not None:
            self.go(keyframe.frame)

    def _scrub(self) -> None:
        if self.panel.frame != self.frame:
            self.go(self.panel.frame)

    def _zoom(self) -> None:
        middle = None if self.stage.zoomed else self.middle()
        self.stage.zoom(middle)

    def _look(self, look: Look) -> None:
        self.stage.look(look, self.middle())
        self._drawn = -1
        self.refresh()

    def middle(self) -> Array:
        """Return where the object's middle (3,) is, or where a person usually is."""
        pose = self.shown.pose
        return np.array([0.0, 0.0, 2.0]) if pose is None else self.stage.middle_of(pose)

    # Editing.

    def edit(self, change: Callable[[edits.Editing], edits.Editing]) -> None:
        """Change the keyframes, and write them at once."""
        self.require_editable()
        told = self.kept.trouble
        self.editing = change(self.editing)
        self.editing = self.kept.save(self.editing)
        self.panel.show_part(self.editing.part)
        self.refresh()
        if self.kept.trouble is not None and told is None:
            self.visit.tell(self.kept.trouble, title="Keyframes are NOT SAVED")

    def require_editable(self) -> None:
        """Raise LabellingError where keyframes cannot be changed here."""
        reason = self.recording.unlabelled_because
        if not self.kept.claimed:
            reason = (
                "this is read only, as another tab or studio labels this object here: press "
                "“Take over” first"
            )
        if reason is not None:
            self.refresh()
            raise LabellingError(reason)

    def set_pose(self, pose: Pose | None) -> None:
        """Set the keyframe of this frame; None marks the object as absent."""
        keyframe = Keyframe(
            frame=self.frame,
            time_ns=int(self.recording.times_ns[self.frame]),
            camera_from_object=None if pose is None else pose_message(*pose),
            relative_to=None if pose is None else self.editing.part,
        )
        self.edit(lambda editing: edits.with_keyframe(editing, keyframe))

    def require_image(self) -> Image:
        """Return the image of this frame; raises LabellingError where it has no depth."""
        image = self.recording.image(self.frame)
        if image is None or image.depth is None:
            raise LabellingError("this frame has no depth: choose one that has")
        return image

    def require_pose(self) -> Pose:
        """Return the pose that is shown; raises LabellingError where the object is absent."""
        if self.shown.pose is None:
            raise LabellingError("the object is absent here: delete the keyframe that says so")
        return self.shown.pose

    def _take_over(self) -> None:
        self.kept.take_over()
        self.editing = self.kept.load()
        self.refresh()

    def acts(self) -> Mapping[str, Act]:
        """Return what keys and buttons do to what is looked at."""
        return {
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
            "take_over": self._take_over,
        }
