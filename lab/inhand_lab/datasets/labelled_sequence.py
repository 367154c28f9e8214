"""Reads a recording as training needs it."""

import logging

import numpy as np
from inhand_runtime.wording import counted
from inhand_tracker.body.convention_map import canonical_joints
from inhand_tracker.body.convention_table import CANONICAL, TABLE
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.wire.conversion import joints_of

from inhand_lab.datasets.dataset import Dataset, DatasetEntry
from inhand_lab.datasets.followed_people import follow_people, frames_of_others
from inhand_lab.datasets.recorded_frames import convention_of
from inhand_lab.datasets.recording_times import frame_rate_of
from inhand_lab.datasets.stretches import entry_frames
from inhand_lab.datasets.tracks import true_track
from inhand_lab.datasets.wild_labels import without_wild_labels

log = logging.getLogger(__name__)


def labelled_sequence(dataset: Dataset, entry: DatasetEntry) -> LabelledSequence:
    """Read the bodies and labels of a recording or stretch; frames without either hold NaN.

    So do wild labels, and frames in which another person has the object than in most, which
    warnings name. Bodies are canonical where their convention
    is tabulated. Raises DatasetError or RecordingError.
    """
    frames = entry_frames(dataset, entry)
    joints = np.full((len(frames), 20, 3), np.nan)
    for index, followed in enumerate(follow_people(frames)):
        if followed.person is not None:
            joints[index] = joints_of(followed.person)
    passed = frames_of_others(frames)
    joints[passed] = np.nan
    times_ns = np.array([frame.time_ns for frame in frames], np.int64)
    truth = without_wild_labels(entry.file, true_track(frames), times_ns)
    if passed.any():
        log.warning(
            "%s: the object passes from one person to another: %s of %s are of the other, and left "
            "out; cut the recording where it passes, to learn from both",
            entry.file,
            passed.sum(),
            counted(len(frames), "frame"),
        )
        truth.translations[passed] = truth.rotations[passed] = np.nan
    convention = convention_of(frames)
    return LabelledSequence(
        entry.participant,
        entry.handedness == "left",
        canonical_joints(joints, convention),
        truth.translations,
        truth.rotations,
        frame_rate_of(entry, times_ns),
        CANONICAL if convention in TABLE else convention,
        entry.file,
    )
