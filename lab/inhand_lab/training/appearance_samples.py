"""Reads the frames of labelled recordings from which an object's appearance is learned."""

from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, Person, RgbdFrame
from inhand_tracker.sight.appearance import AppearanceSample
from inhand_tracker.wire.conversion import image_of, joints_of

from inhand_lab.datasets.dataset import Dataset, DatasetEntry
from inhand_lab.datasets.followed_people import follow_people
from inhand_lab.datasets.frame_pixels import pixels_of
from inhand_lab.datasets.recorded_frames import (
    RecordedFrame,
    load_camera_info,
)
from inhand_lab.datasets.stretches import entry_frames
from inhand_lab.training.parameters import DEFAULT_TRAINING, TrainingParameters


def appearance_samples(
    dataset: Dataset,
    entries: Sequence[DatasetEntry],
    parameters: TrainingParameters = DEFAULT_TRAINING,
) -> Iterator[AppearanceSample]:
    """Yield some frames of some recordings of one object; none of recordings without images.

    Damaged pixels are passed over. Raises DatasetError or RecordingError.
    """
    chosen = entries[:: -(-len(entries) // parameters.appearance_recordings)]
    frames = parameters.appearance_frames // max(len(chosen), 1)
    for entry in chosen:
        yield from _samples_of(dataset, entry, frames)


def _samples_of(dataset: Dataset, entry: DatasetEntry, most: int) -> Iterator[AppearanceSample]:
    """Yield frames, evenly spaced, of one recording: ``most`` of them at the most."""
    path = dataset.path(entry)
    frames = entry_frames(dataset, entry)
    camera = next((frame.label.camera for frame in frames if frame.label is not None), None)
    info = None if camera is None else load_camera_info(path, camera)
    if info is None:
        return
    chosen = np.linspace(0, len(frames) - 1, min(most, len(frames))).astype(int)
    people = [followed.person for followed in follow_people(frames)]
    for index, pixels in pixels_of(path, frames, camera):
        if index in chosen:
            with suppress(MessageError):
                yield from _sample_of(frames[index], people[index], pixels, info)


def _sample_of(
    frame: RecordedFrame, person: Person | None, pixels: RgbdFrame, info: CameraInfo
) -> Iterator[AppearanceSample]:
    """Yield the frame where it has a label and an image; raises MessageError."""
    if frame.label is None or frame.label.camera_from_object is None:
        return
    image = image_of(pixels, info, ("colour", "depth"))
    if image is not None:
        pose = frame.label.camera_from_object
        joints = None if person is None else joints_of(person)
        yield image, np.array(pose.translation), np.array(pose.rotation), joints
