"""Reads a recording: bodies with labels frame by frame, and apart from them pixels and camera."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_runtime.recording import read_recording
from inhand_schemas.messages import CameraInfo, ObjectPose, Person, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, LABEL, RGBD, SKELETONS
from inhand_tracker.geometry.camera import Intrinsics, intrinsics_of

from inhand_lab.datasets.dataset import CAMERA, Dataset, DatasetError
from inhand_lab.datasets.label_joining import check_objects, check_people, join_labels
from inhand_lab.datasets.recording_times import check_times
from inhand_lab.datasets.units import check_units


@dataclass(frozen=True)
class RecordedFrame:
    """One moment of a recording: its people, and the true pose of its object where labelled.

    ``convention`` names whose joints the people have; None where it is not said.
    """

    sequence: int
    time_ns: int
    people: tuple[Person, ...]
    label: ObjectPose | None
    convention: str | None = None


def load_frames(
    path: Path, object_name: str | None, camera: str | None = None
) -> list[RecordedFrame]:
    """Read the skeletons and labels of a recording, in order, without pixels.

    Of several cameras the skeletons come from the one in which the labels were made, or else from
    the ``camera`` that is named, and so do the labels where they were made in several. Raises
    DatasetError where that is not exactly one, for times that are no clock's, units that are no
    metres, and labels that are of no frame, object or person of the recording.
    """
    labels: list[ObjectPose] = []
    objects: set[str] = set()
    skeletons: dict[str, list[Skeletons]] = {}
    for recorded in read_recording(path, streams=(LABEL.stream, SKELETONS.stream)):
        message = recorded.message()
        if isinstance(message, Skeletons):
            skeletons.setdefault(recorded.name, []).append(message)
        elif isinstance(message, ObjectPose):
            objects.add(message.object)
            if message.object == object_name:
                labels.append(message)
    check_objects(path, object_name, objects)
    if camera in {label.camera for label in labels}:
        labels = [label for label in labels if label.camera == camera]
    labelled = {label.camera for label in labels} or ({camera} if camera else set())
    shown = skeletons.get(_shared_camera(path, labelled, set(skeletons)), [])
    check_times(path, np.array([one.time_ns for one in shown], np.int64))
    joined = join_labels(path, labels, shown)
    check_people(path, labels, shown)
    check_units(path, shown, joined)
    return [
        RecordedFrame(one.sequence, one.time_ns, one.people, label, one.convention)
        for one, label in zip(shown, joined, strict=True)
    ]


def labelled_camera(frames: Iterable[RecordedFrame]) -> str | None:
    """Return the name of the camera in which frames were labelled; None where none is labelled."""
    return next((frame.label.camera for frame in frames if frame.label is not None), None)


def convention_of(frames: Iterable[RecordedFrame]) -> str | None:
    """Return the convention of a recording's skeletons; None where no frame says one."""
    return next((frame.convention for frame in frames if frame.convention is not None), None)


def load_camera(path: Path) -> Intrinsics | None:
    """Read the intrinsics of a recording's first camera; None where none was recorded."""
    info = load_camera_info(path)
    return None if info is None else intrinsics_of(info)


def load_camera_info(path: Path, camera: str | None = None) -> CameraInfo | None:
    """Read the description of the camera of that name, or of the first one; None without any."""
    for recorded in read_recording(path, streams=(INFO.stream,)):
        message = recorded.message()
        if isinstance(message, CameraInfo) and camera in (None, recorded.name):
            return message
    return None


def iterate_pixels(path: Path, camera: str | None = None) -> Iterator[RgbdFrame]:
    """Yield the pixels that one camera of a recording took, or all of them did, in order."""
    for recorded in read_recording(path, streams=(RGBD.stream,)):
        if camera in (None, recorded.name):
            message = recorded.message()
            if isinstance(message, RgbdFrame):
                yield message


def has_images(dataset: Dataset) -> bool:
    """Return whether any recording has pixels; raises RecordingError."""
    return any(
        next(iterate_pixels(dataset.path(entry)), None) is not None for entry in dataset.entries
    )


def _shared_camera(path: Path, labelled: set[str], tracked: set[str]) -> str:
    """Return the one camera that a recording's labels and skeletons share."""
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
