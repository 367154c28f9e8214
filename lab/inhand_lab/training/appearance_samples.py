"""Frames of labelled recordings from which to learn how an object looks."""

from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np
from inhand_schemas.errors import MessageError
from inhand_tracker.sight.appearance import AppearanceSample
from inhand_tracker.wire.conversion import image_of, joints_of

from inhand_lab.datasets.dataset import Dataset, DatasetEntry
from inhand_lab.datasets.recorded_frames import iterate_pixels, load_camera_info, load_frames

RECORDINGS, FRAMES = 12, 60
"""At the most, evenly spaced: an object looks much the same in all."""


def appearance_samples(
    dataset: Dataset, entries: Sequence[DatasetEntry]
) -> Iterator[AppearanceSample]:
    """Some frames of some recordings of one object; none of recordings without images.

    Damaged pixels are passed over. Raises DatasetError or RecordingError.
    """
    some = entries[:: -(-len(entries) // RECORDINGS)]
    wanted = FRAMES // max(len(some), 1)
    for entry in some:
        path = dataset.path(entry)
        frames = load_frames(path, entry.object)
        labels = [frame.label for frame in frames if frame.label is not None]
        if not labels:
            continue
        info = load_camera_info(path, labels[0].camera)
        if info is None:
            continue
        chosen = np.linspace(0, len(frames) - 1, min(wanted, len(frames))).astype(int)
        by_time = {frames[index].time_ns: frames[index] for index in chosen}
        for pixels in iterate_pixels(path, labels[0].camera):
            frame = by_time.get(pixels.time_ns)
            if frame is None or frame.label is None or frame.label.camera_from_object is None:
                continue
            with suppress(MessageError):
                image = image_of(pixels, info, ("colour", "depth"))
                if image is not None:
                    pose = frame.label.camera_from_object
                    joints = joints_of(frame.people[0]) if frame.people else None
                    yield image, np.array(pose.translation), np.array(pose.rotation), joints
