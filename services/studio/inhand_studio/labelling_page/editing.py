"""The keyframes of one object in one recording while they are edited, with all that was undone."""

from dataclasses import dataclass, replace

from inhand_lab.labelling.keyframes import Keyframe

Keyframes = tuple[Keyframe, ...]
"""In the order of their frames, one a frame at the most."""


@dataclass(frozen=True)
class Editing:
    """The ``keyframes`` now, what they were before each change, last one last, and after each one
    that was undone; ``on_disk`` are those that are saved, None where none ever were.

    ``part`` names the body part that new keyframes are relative to; None stands for the camera.
    """

    keyframes: Keyframes = ()
    past: tuple[Keyframes, ...] = ()
    future: tuple[Keyframes, ...] = ()
    on_disk: Keyframes | None = None
    part: str | None = None

    @property
    def unsaved(self) -> bool:
        """Whether the disk holds other keyframes than these."""
        return self.keyframes != (self.on_disk or ())

    def at(self, frame: int) -> Keyframe | None:
        """Return the keyframe of a frame, if it has one."""
        return next((one for one in self.keyframes if one.frame == frame), None)

    def before(self, frame: int) -> Keyframe | None:
        """Return the last keyframe before a frame."""
        return next((one for one in reversed(self.keyframes) if one.frame < frame), None)

    def after(self, frame: int) -> Keyframe | None:
        """Return the first keyframe after a frame."""
        return next((one for one in self.keyframes if one.frame > frame), None)


def opened(keyframes: Keyframes) -> Editing:
    """Start to edit keyframes that are on the disk, relative to what the last one is."""
    part = keyframes[-1].relative_to if keyframes else None
    return Editing(keyframes, on_disk=keyframes, part=part)


def with_keyframes(editing: Editing, keyframes: Keyframes) -> Editing:
    """Change the keyframes; what was undone before is gone. No change is none to undo."""
    if keyframes == editing.keyframes:
        return editing
    past = (*editing.past, editing.keyframes)
    return replace(editing, keyframes=keyframes, past=past, future=())


def with_keyframe(editing: Editing, keyframe: Keyframe) -> Editing:
    """Set the keyframe of a frame, in place of the one that it has."""
    others = [one for one in editing.keyframes if one.frame != keyframe.frame]
    keyframes = sorted([*others, keyframe], key=lambda one: one.frame)
    return with_keyframes(editing, tuple(keyframes))


def without_keyframe(editing: Editing, frame: int) -> Editing:
    """Take the keyframe of a frame away, if it has one."""
    return with_keyframes(editing, tuple(one for one in editing.keyframes if one.frame != frame))


def undone(editing: Editing) -> Editing:
    """Take the last change back, if there is one."""
    if not editing.past:
        return editing
    *past, keyframes = editing.past
    future = (*editing.future, editing.keyframes)
    return replace(editing, keyframes=keyframes, past=tuple(past), future=future)


def redone(editing: Editing) -> Editing:
    """Do again what was taken back last, if anything was."""
    if not editing.future:
        return editing
    *future, keyframes = editing.future
    past = (*editing.past, editing.keyframes)
    return replace(editing, keyframes=keyframes, past=past, future=tuple(future))


def saved(editing: Editing, keyframes: Keyframes) -> Editing:
    """Note which keyframes the disk holds now."""
    return replace(editing, on_disk=keyframes)


def relative_to(editing: Editing, part: str | None, frame: int) -> Editing:
    """Choose the body part of new keyframes, and of the one of a frame, if it has a pose."""
    editing = replace(editing, part=part)
    here = editing.at(frame)
    if here is None or here.camera_from_object is None:
        return editing
    return with_keyframe(
        editing,
        Keyframe(
            frame=frame,
            time_ns=here.time_ns,
            camera_from_object=here.camera_from_object,
            relative_to=part,
        ),
    )
