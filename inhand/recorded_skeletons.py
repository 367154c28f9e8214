"""Completes recordings of colour and depth: estimates the skeletons of the people in them.

Those of simulated people can get their labels' true joints instead.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from inhand_capture.estimation.estimator import EstimationError, SkeletonEstimator
from inhand_capture.estimation.found_person import PoseNetwork
from inhand_recorder.attachments import copy_attachments
from inhand_runtime.errors import InhandError
from inhand_runtime.pixels import decode_colour, decode_depth
from inhand_runtime.recording import RecordedMessage, RecordingError, read_recording
from inhand_runtime.recording.copying import (
    copy_message,
    copy_metadata,
    write_beside,
    written_or_gone,
)
from inhand_schemas.conventions import SIMULATED
from inhand_schemas.errors import MessageError
from inhand_schemas.fields import JointState, Vector3
from inhand_schemas.keys import parse_key
from inhand_schemas.messages import CameraInfo, ObjectPose, Person, Skeletons
from inhand_schemas.topics import INFO, LABEL, RGBD, SKELETONS
from msgspec import structs


@dataclass
class CameraSkeletons:
    """What was estimated of one camera's frames.

    ``frames`` counts all, ``with_people`` those with somebody in view and ``unusable`` those
    without skeletons; ``reason`` says why the first of these has none.
    """

    frames: int = 0
    with_people: int = 0
    unusable: int = 0
    reason: str = ""


@dataclass
class _Cameras:
    """What a recording holds of its cameras: infos, names of those with frames and skeletons."""

    infos: dict[str, CameraInfo] = field(default_factory=dict)
    with_frames: set[str] = field(default_factory=set)
    with_skeletons: set[str] = field(default_factory=set)


def add_skeletons(
    path: Path,
    output: Path,
    new_network: Callable[[], PoseNetwork],
    *,
    convention: str | None = None,
    replace: bool = False,
) -> dict[str, CameraSkeletons]:
    """Write a recording, completed, to the new file ``output``; the input is never changed.

    ``convention`` names that of the network's skeletons. With ``replace`` the skeletons that it has
    are left out. Raises RecordingError where it has
    skeletons already, or no pictures, or no camera's info, and InhandError where none of a camera's
    frames serves.
    """
    cameras = _cameras_of(path)
    wanted = _cameras_to_complete(path, cameras, replace=replace)
    estimators = {
        name: SkeletonEstimator(new_network(), cameras.infos[name]) for name in sorted(wanted)
    }
    estimated = {name: CameraSkeletons() for name in estimators}
    with written_or_gone(output) as writer:
        for message in read_recording(path, apart=True):
            if message.topic is SKELETONS and message.name in wanted and not message.apart:
                continue
            copy_message(writer, message)
            if not message.apart and message.topic is RGBD and message.name in wanted:
                camera = message.name
                skeletons = _estimate(message, estimators[camera], estimated[camera])
                if skeletons is not None:
                    skeletons = structs.replace(skeletons, convention=convention)
                    key = SKELETONS.key(parse_key(message.key).site, camera)
                    write_beside(writer, key, message, SKELETONS.encode(skeletons))
        about = {"source": path.name, "estimated": " ".join(wanted)}
        copy_metadata(writer, path, "skeletons", about)
        copy_attachments(writer, path)
        _require_skeletons(path, estimated)
    return estimated


def true_skeletons(path: Path, output: Path) -> int:
    """Write a recording whose skeletons have the true joints of its labels to ``output``.

    What a tracker does with it is what it would do with skeletons without any error. Returns the
    number of skeletons; raises RecordingError where the labels hold no joints.
    """
    joints = _true_joints(path)
    if not joints:
        raise RecordingError(
            f"{path} holds no true joints: only labels of simulated people have them"
        )
    written = 0
    with written_or_gone(output) as writer:
        for message in read_recording(path, apart=True):
            if message.apart:
                copy_message(writer, message)
                continue
            payload = message.payload
            if message.topic is SKELETONS:
                skeletons: Skeletons = SKELETONS.decode(payload)
                truth = joints.get((message.name, skeletons.sequence))
                if truth is None:
                    continue
                person = skeletons.people[0].id if skeletons.people else 0
                people = (_exact_person(person, truth),)
                payload = SKELETONS.encode(
                    structs.replace(skeletons, people=people, convention=SIMULATED)
                )
                written += 1
            write_beside(writer, message.key, message, payload)
        copy_metadata(writer, path, "skeletons", {"source": path.name, "true": "labels"})
        copy_attachments(writer, path)
    return written


def _true_joints(path: Path) -> dict[tuple[str, int], tuple[Vector3, ...]]:
    """Return the person's true joints by camera and number of the frame."""
    joints = {}
    for message in read_recording(path, streams=(LABEL.stream,)):
        label: ObjectPose = LABEL.decode(message.payload)
        if label.person_joints is not None:
            joints[label.camera, label.sequence] = label.person_joints
    return joints


def _exact_person(number: int, joints: tuple[Vector3, ...]) -> Person:
    state: JointState = "tracked"
    count = len(joints)
    return Person(id=number, joints=joints, states=(state,) * count, confidences=(1.0,) * count)


def _cameras_of(path: Path) -> _Cameras:
    cameras = _Cameras()
    for message in read_recording(path, streams=(INFO.stream, RGBD.stream, SKELETONS.stream)):
        if message.topic is INFO:
            cameras.infos.setdefault(message.name, INFO.decode(message.payload))
        elif message.topic is RGBD:
            cameras.with_frames.add(message.name)
        else:
            cameras.with_skeletons.add(message.name)
    return cameras


def _cameras_to_complete(path: Path, cameras: _Cameras, *, replace: bool) -> list[str]:
    """Return the cameras whose skeletons are to be estimated; raises RecordingError."""
    if not cameras.with_frames:
        raise RecordingError(f"{path} holds no pictures: skeletons come from pictures with depth")
    wanted = sorted(
        cameras.with_frames if replace else cameras.with_frames - cameras.with_skeletons
    )
    if not wanted:
        raise RecordingError(
            f"{path} has skeletons already: add --replace to have them estimated instead"
        )
    if without := [name for name in wanted if name not in cameras.infos]:
        raise RecordingError(
            f"{path} lacks the info of camera {without[0]}: `inhand recording repair` adds it"
        )
    return wanted


def _estimate(
    message: RecordedMessage, estimator: SkeletonEstimator, counts: CameraSkeletons
) -> Skeletons | None:
    """Estimate the skeletons of one recorded frame, and count; None where it has none to give."""
    counts.frames += 1
    try:
        frame = message.frame()
        colour = None if frame.colour is None else decode_colour(frame.colour)
        depth = None if frame.depth is None else decode_depth(frame.depth)
        people = estimator.estimate(colour, depth, frame.time_ns)
    except (EstimationError, MessageError) as error:
        counts.reason = counts.reason or str(error)
        counts.unusable += 1
        return None
    counts.with_people += bool(people)
    return Skeletons(sequence=frame.sequence, time_ns=frame.time_ns, people=people)


def _require_skeletons(path: Path, estimated: dict[str, CameraSkeletons]) -> None:
    for name, counts in estimated.items():
        if counts.unusable == counts.frames:
            raise InhandError(f"{path}, camera {name}: {counts.reason}")
