"""What of a recording is labelled: the frames of one camera, and the body of one person."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_schemas.messages import CameraInfo
from inhand_tracker.body.skeleton import without_impossible
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.people.following import PersonFollower

from inhand_lab.datasets.followed_people import show_hips
from inhand_lab.datasets.frame_index import FrameIndex, FrameStamp, open_frames
from inhand_lab.datasets.units import check_bodies, written_joints
from inhand_lab.labelling.keyframes import Keyframe, KeyframeFile, LabellingError

_BLOCK = 1000
"""Frames whose bodies are in memory at a time as messages."""


@dataclass(frozen=True)
class Scene:
    """T frames of a recording as one camera saw them, without labels and pixels.

    ``times_ns`` (T,); ``joints`` (T, 20, 3) of the person who is followed, NaN where missing, whose
    id in each frame is in ``people``.
    """

    path: Path
    camera: str
    info: CameraInfo
    frames: Sequence[FrameStamp]
    times_ns: Indices
    joints: Array
    people: tuple[int | None, ...]


def load_scene(path: Path, camera: str) -> Scene:
    """Read what is to be labelled of a recording; raises RecordingError, LabellingError or
    DatasetError for times and units that are none."""
    with open_frames(path, camera) as frames:
        if frames.note is not None:
            raise LabellingError(frames.note)
        info = frames.camera_info()
        if info is None:
            raise LabellingError(
                f"{path} lacks the info of camera {camera}: `inhand recording repair` adds it"
            )
        stamps, joints, people = _follow(frames, range(len(frames)))
    return Scene(path, camera, info, stamps, frames.times_ns, joints, people)


def joints_between(frames: FrameIndex, first: int, last: int) -> Array:
    """Read the joints (T, 20, 3) of whom a tracker would follow from frame ``first`` to ``last``.

    Nothing before is read, so that of several people it may be another one than in the whole scene.
    Raises RecordingError, and DatasetError for bodies that are not in metres.
    """
    return _follow(frames, range(first, last + 1))[1]


def _follow(
    frames: FrameIndex, chosen: range
) -> tuple[list[FrameStamp], Array, tuple[int | None, ...]]:
    """Read the bodies of successive frames: their stamps, and the joints and ids of whom a tracker
    would follow. Raises DatasetError for bodies that are not in metres."""
    count = len(chosen)
    hips = show_hips(one for frame in chosen for one in frames.skeletons(frame).people)
    follower, joints = PersonFollower(needs_hips=hips), np.full((count, 20, 3), np.nan)
    stamps, ids, owners, written = [], [], [], []
    for block in range(0, count, _BLOCK):
        shown = [frames.skeletons(frame) for frame in chosen[block : block + _BLOCK]]
        everybody = [person for message in shown for person in message.people]
        bodies, first = written_joints(everybody), 0
        for frame, message in enumerate(shown, block):
            person = follower.choose(message.people, message.time_ns)
            stamps.append(FrameStamp(message.sequence, message.time_ns))
            ids.append(None if person is None else person.id)
            if person is not None:
                joints[frame] = bodies[first + message.people.index(person)]
            owners += [frame] * len(message.people)
            first += len(message.people)
        written.append(bodies.astype(np.float32))
    nowhere = np.full((count, 3), np.nan)
    check_bodies(frames.path, np.array(owners, int), np.concatenate(written), nowhere)
    return stamps, without_impossible(joints), tuple(ids)


def check_keyframes(scene: Scene, contents: KeyframeFile, object_name: str) -> None:
    """Raise LabellingError for keyframes of another object or recording, or too few of them."""
    path, keyframes = scene.path, contents.keyframes
    if contents.object != object_name:
        raise LabellingError(
            f"these are keyframes of {contents.object!r}, and {object_name!r} is to be labelled: "
            f"give --object {contents.object}, or the keyframes of {object_name}"
        )
    if not any(one.pose is not None for one in keyframes):
        raise LabellingError(f"no keyframe of {path} has a pose: set two or more")
    if beyond := [one for one in keyframes if one.frame >= len(scene.frames)]:
        raise LabellingError(
            f"{path} has frames 0 to {len(scene.frames) - 1}, and there is a keyframe of frame "
            f"{beyond[0].frame}: these are the keyframes of {contents.recording}"
        )
    for one in keyframes:
        _check_time(scene, one, contents)


def _check_time(scene: Scene, keyframe: Keyframe, contents: KeyframeFile) -> None:
    time_ns = int(scene.times_ns[keyframe.frame])
    if keyframe.time_ns != time_ns:
        raise LabellingError(
            f"{scene.path}: frame {keyframe.frame} was taken at {time_ns}, and its keyframe says "
            f"{keyframe.time_ns}: these are the keyframes of {contents.recording}"
        )
