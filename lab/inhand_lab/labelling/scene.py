"""What of a recording is labelled: the frames of one camera, and the body of one person."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_schemas.messages import CameraInfo
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.wire.conversion import joints_of

from inhand_lab.datasets.followed_people import follow_people
from inhand_lab.datasets.recorded_frames import RecordedFrame, load_camera_info, load_frames
from inhand_lab.labelling.keyframes import Keyframe, KeyframeFile, LabellingError


@dataclass(frozen=True)
class Scene:
    """T frames of a recording as one camera saw them, without labels and pixels.

    ``times_ns`` (T,); ``joints`` (T, 20, 3) of the person who is followed, NaN where missing, whose
    id in each frame is in ``people``.
    """

    path: Path
    camera: str
    info: CameraInfo
    frames: Sequence[RecordedFrame]
    times_ns: Indices
    joints: Array
    people: tuple[int | None, ...]


def load_scene(path: Path, camera: str) -> Scene:
    """Read what is to be labelled of a recording; raises RecordingError, LabellingError or
    DatasetError for times and units that are none."""
    frames = load_frames(path, None, camera)
    if not frames:
        raise LabellingError(
            f"{path} holds no skeletons: `inhand recording skeletons` adds them from its pictures"
        )
    info = load_camera_info(path, camera)
    if info is None:
        raise LabellingError(
            f"{path} lacks the info of camera {camera}: `inhand recording repair` adds it"
        )
    people = [followed.person for followed in follow_people(frames)]
    joints = np.full((len(frames), 20, 3), np.nan)
    for index, person in enumerate(people):
        if person is not None:
            joints[index] = joints_of(person)
    times_ns = np.array([frame.time_ns for frame in frames], np.int64)
    ids = tuple(None if person is None else person.id for person in people)
    return Scene(path, camera, info, frames, times_ns, joints, ids)


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
