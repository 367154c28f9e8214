"""Reads a recording as training needs it."""

import numpy as np
from inhand_tracker.mapping.learning import LabelledSequence
from inhand_tracker.people.following import PersonFollower
from inhand_tracker.wire.conversion import joints_of

from inhand_lab.datasets.dataset import Dataset, DatasetEntry
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.datasets.tracks import true_track


def labelled_sequence(dataset: Dataset, entry: DatasetEntry) -> LabelledSequence:
    """Read a recording's bodies and labels; frames without body or label hold NaN."""
    frames = load_frames(dataset.path(entry), entry.object)
    joints = np.full((len(frames), 20, 3), np.nan)
    follower = PersonFollower()
    for index, frame in enumerate(frames):
        person = follower.choose(frame.people, frame.time_ns)
        if person is not None:
            joints[index] = joints_of(person)
    truth = true_track(frames)
    return LabelledSequence(
        entry.participant,
        entry.handedness == "left",
        joints,
        truth.translations,
        truth.rotations,
        entry.frame_rate,
    )
