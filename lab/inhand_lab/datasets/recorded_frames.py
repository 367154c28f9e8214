"""Reads a recording frame by frame: bodies with labels, and apart from them pixels and camera."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from inhand_runtime.recording import read_recording
from inhand_schemas.messages import CameraInfo, ObjectPose, Person, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, LABEL, RGBD, SKELETONS
from inhand_tracker.geometry.camera import Intrinsics, intrinsics_of

from inhand_lab.datasets.dataset import CAMERA, Dataset, DatasetError


@dataclass(frozen=True)
class RecordedFrame:
    """One moment of a recording; ``label`` is the true pose where it is known."""

    sequence: int
    time_ns: int
    people: tuple[Person, ...]
    label: ObjectPose | None


def load_frames(path: Path, object_name: str | None) -> list[RecordedFrame]:
    """Skeletons and labels of a recording, in order, without pixels.

    Of several cameras' skeletons, those that the labels were made in; raises DatasetError where
    the labels do not tell.
    """
    labels: dict[tuple[int, int], ObjectPose] = {}
    labelled: set[str] = set()
    skeletons: dict[str, list[Skeletons]] = {}
    for recorded in read_recording(path, streams=(LABEL.stream, SKELETONS.stream)):
        message = recorded.message()
        if isinstance(message, Skeletons):
            skeletons.setdefault(recorded.name, []).append(message)
        elif isinstance(message, ObjectPose) and message.object == object_name:
            labels[message.sequence, message.time_ns] = message
            labelled.add(message.camera)
    camera = _labelled_camera(path, labelled, set(skeletons))
    return [
        RecordedFrame(s.sequence, s.time_ns, s.people, labels.get((s.sequence, s.time_ns)))
        for s in skeletons.get(camera, ())
    ]


def load_camera(path: Path) -> Intrinsics | None:
    """The first camera of a recording, where it says."""
    info = load_camera_info(path)
    return None if info is None else intrinsics_of(info)


def load_camera_info(path: Path, camera: str | None = None) -> CameraInfo | None:
    """What a recording says of the camera of that name, or of the first one."""
    for recorded in read_recording(path, streams=(INFO.stream,)):
        message = recorded.message()
        if isinstance(message, CameraInfo) and camera in (None, recorded.name):
            return message
    return None


def iterate_pixels(path: Path, camera: str | None = None) -> Iterator[RgbdFrame]:
    """The frames of a camera, or of all, of a recording, in order."""
    for recorded in read_recording(path, streams=(RGBD.stream,)):
        if camera in (None, recorded.name):
            message = recorded.message()
            if isinstance(message, RgbdFrame):
                yield message


def has_images(dataset: Dataset) -> bool:
    """Whether any recording has pixels; raises RecordingError."""
    return any(
        next(iterate_pixels(dataset.path(entry)), None) is not None for entry in dataset.entries
    )


def _labelled_camera(path: Path, labelled: set[str], tracked: set[str]) -> str:
    """The camera that a recording's labels and skeletons share."""
    cameras = labelled or tracked
    if len(cameras) > 1:
        raise DatasetError(
            f"{path}: {'labels were made in' if labelled else 'skeletons and no label are of'} "
            f"{len(cameras)} cameras ({', '.join(sorted(cameras))}): label it in one"
        )
    if tracked and not cameras <= tracked:
        raise DatasetError(
            f"{path}: the labels were made in camera {min(cameras)!r}, and the skeletons are of "
            f"{', '.join(sorted(tracked))}: label it in one of these"
        )
    return min(cameras, default=CAMERA)
