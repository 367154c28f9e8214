"""How an object looks, learned from the pictures of labelled recordings."""

from collections.abc import Iterator, Sequence

import numpy as np
from inhand_tracker.appearance import Appearance, Sample, learn_appearance
from inhand_tracker.shape import ObjectShape

from inhand_lab.dataset import Dataset, Entry, load_frames
from inhand_lab.observations import observe

PICTURES_PER_RECORDING = 24
"""That are looked at, evenly spaced: colours change little from one to the next."""


def appearance_from(
    dataset: Dataset, entries: Sequence[Entry], shape: ObjectShape
) -> Appearance | None:
    """Learn from labelled recordings; None where they hold no pictures.

    Raises DatasetError or RecordingError.
    """
    samples = (sample for entry in entries for sample in _samples(dataset, entry))
    return learn_appearance(shape, samples)


def _samples(dataset: Dataset, entry: Entry) -> Iterator[Sample]:
    frames = load_frames(dataset.path(entry), entry.object)
    wanted = {
        frame.time_ns for frame in frames[:: max(1, len(frames) // PICTURES_PER_RECORDING)]
    }
    for frame, observation in zip(
        frames,
        observe(dataset.path(entry), frames, ("colour", "depth"), at=wanted),
        strict=True,
    ):
        pose = None if frame.label is None else frame.label.camera_from_object
        if observation.image is not None and pose is not None:
            yield (
                observation.image,
                np.array(pose.translation),
                np.array(pose.rotation),
                observation.joints,
            )
