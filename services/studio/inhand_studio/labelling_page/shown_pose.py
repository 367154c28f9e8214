"""Where the object is in a frame by the keyframes around it, for a person who looks at it."""

from dataclasses import dataclass, replace
from typing import Literal

import msgspec
import numpy as np
from inhand_lab.labelling.body_parts import part_of
from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.interpolation import interpolate
from inhand_lab.labelling.keyframes import Keyframe
from inhand_lab.labelling.parameters import DEFAULT_LABELLING
from inhand_tracker.body.skeleton import Bases
from inhand_tracker.shape.shape import Symmetry

from inhand_studio.labelling_page.editing import Editing
from inhand_studio.labelling_page.opened import OpenedRecording
from inhand_studio.labelling_page.placing import SAME_ROTATION
from inhand_studio.scene_parts import UPRIGHT

Standing = Literal["keyframe", "between", "refined", "guess", "absent"]

FIRST_M = 1.5
"""Metres before the camera at which an object stands of which nothing is known."""


@dataclass(frozen=True)
class ShownPose:
    """A pose, or None where the object is absent, and what it is: a ``keyframe``, ``between`` two,
    a ``guess`` that is no label, or ``absent``; ``note`` says what the pose hides."""

    pose: Pose | None
    standing: Standing
    note: str = ""


def shown_pose(
    editing: Editing, recording: OpenedRecording, frame: int, symmetries: tuple[Symmetry, ...]
) -> ShownPose:
    """Find what is shown in a frame; raises RecordingError."""
    here, before, after = editing.at(frame), editing.before(frame), editing.after(frame)
    if here is not None:
        return ShownPose(here.pose, "keyframe" if here.pose is not None else "absent")
    if before is not None and after is not None:
        if before.pose is None and after.pose is None:
            return ShownPose(None, "absent")
        if before.pose is not None and after.pose is not None:
            return _between(before, after, recording, frame, symmetries)
    nearest = [one for one in (before, after) if one is not None and one.pose is not None]
    if nearest:
        carried = _carried(nearest[0], recording, frame)
        return ShownPose(carried, "guess", "no label here: it is not between two keyframes")
    return ShownPose(_first(editing.part, recording, frame), "guess", "no keyframe yet")


def part_basis(name: str | None, recording: OpenedRecording, frame: int) -> Pose:
    """Return where a body part is in a frame, as a pose; the camera's own, which is nowhere, for
    None and where the part is not seen."""
    if name is not None:
        basis = _basis(name, recording, frame)
        if basis is not None:
            return basis.origins[0], basis.rotations[0]
    return np.zeros(3), SAME_ROTATION


def _basis(name: str, recording: OpenedRecording, frame: int) -> Bases | None:
    basis = part_of(recording.joints([frame]), name)
    return basis if np.isfinite(basis.origins).all() else None


def _between(
    before: Keyframe,
    after: Keyframe,
    recording: OpenedRecording,
    frame: int,
    symmetries: tuple[Symmetry, ...],
) -> ShownPose:
    """Interpolate as labels are, of the frames of the stretch only what this one needs."""
    whole = np.arange(before.frame, after.frame + 1)
    nobody = np.broadcast_to(np.nan, (len(whole), 20, 3))
    ends = _renumbered(before, 0, None), _renumbered(after, len(whole) - 1, None)
    plain = interpolate(ends, recording.times_ns[whole], nobody, symmetries)
    here = frame - before.frame
    pose = plain.translations[here], plain.rotations[here]
    if not np.isfinite(pose[0]).all():
        return ShownPose(_carried(before, recording, frame), "guess", plain.notes[-1])
    if before.relative_to is None:
        return ShownPose(pose, "between")
    three = np.array([before.frame, frame, after.frame])
    if _basis(before.relative_to, recording, frame) is None:
        three = whole
        unseen = f"the {before.relative_to} is not seen here: it is taken from the frames around"
    else:
        unseen = ""
    ends = (
        _renumbered(before, 0, before.relative_to),
        _renumbered(after, len(three) - 1, before.relative_to),
    )
    any_step = replace(DEFAULT_LABELLING, longest_step_s=np.inf)
    times_ns, joints = recording.times_ns[three], recording.joints(three.tolist())
    found = interpolate(ends, times_ns, joints, symmetries, any_step)
    index = int(np.flatnonzero(three == frame)[0])
    pose = found.translations[index], found.rotations[index]
    return ShownPose(pose, "between", " ".join(found.notes) or unseen)


def _renumbered(keyframe: Keyframe, frame: int, part: str | None) -> Keyframe:
    return msgspec.structs.replace(keyframe, frame=frame, relative_to=part)


def _carried(keyframe: Keyframe, recording: OpenedRecording, frame: int) -> Pose | None:
    """Return a keyframe's pose in another frame, if the object keeps to its body part."""
    pose, name = keyframe.pose, keyframe.relative_to
    if pose is None or name is None:
        return pose
    first, now = _basis(name, recording, keyframe.frame), _basis(name, recording, frame)
    if first is None or now is None:
        return pose
    place, turn = now.to_camera(*first.from_camera(pose[0][None], pose[1][None]))
    return place[0], turn[0]


def _first(part: str | None, recording: OpenedRecording, frame: int) -> Pose:
    """Return a pose from which to begin: at a body part, or before the camera."""
    for name in (part, "right hand", "trunk"):
        place = part_basis(name, recording, frame)[0]
        if place.any():
            return place, UPRIGHT
    return np.array([0.0, 0.0, FIRST_M]), UPRIGHT
