"""Finds joints that are absent from all recordings: nobody's legs, say, are ever seen."""

from collections.abc import Sequence

import numpy as np
from inhand_tracker.body.stand_ins import REPLACEABLE
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.mapping.labelled_sequence import LabelledSequence

from inhand_lab.datasets.dataset import DatasetEntry, DatasetError
from inhand_lab.datasets.joint_names import named_joints
from inhand_lab.training.parameters import DEFAULT_TRAINING


def absent_of(joints: Array) -> tuple[int, ...]:
    """Return those joints of a body (T, 20, 3) that can be absent, and are in nearly all frames."""
    seen = np.asarray(np.isfinite(joints).all(axis=2))
    somebody = seen[seen.any(axis=1)]
    if len(somebody) == 0:
        return ()
    missing = 1.0 - somebody.mean(axis=0)
    return tuple(j for j in sorted(REPLACEABLE) if missing[j] >= DEFAULT_TRAINING.absent_share)


def absent_joints(
    entries: Sequence[DatasetEntry], sequences: Sequence[LabelledSequence]
) -> tuple[int, ...]:
    """Return the joints that are absent from all recordings.

    Raises DatasetError where one recording lacks throughout what another one has.
    """
    by_recording = [absent_of(sequence.joints) for sequence in sequences]
    for entry, absent in zip(entries, by_recording, strict=True):
        if set(absent) != set(by_recording[0]):
            one, other = (entry, entries[0]) if absent else (entries[0], entry)
            lacking = sorted(set(absent) ^ set(by_recording[0]))
            raise DatasetError(
                f"{one.file} and {other.file} do not show the same joints: one of them never has "
                f"{named_joints(lacking)}; take one kind out of dataset.toml, or take these joints "
                "as missing in all"
            )
    return by_recording[0]
