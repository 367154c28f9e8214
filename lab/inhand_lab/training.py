"""Training a model from a dataset."""

from collections.abc import Collection

import numpy as np
from inhand_tracker.learning import LabelledSequence, UnusableSequenceError, learn
from inhand_tracker.model_file import Model
from inhand_tracker.viewpoints import find_viewpoints

from inhand_lab.dataset import Dataset, DatasetError, Entry, labelled_sequence

FASTEST_M_PER_S = 60.0
"""Faster than the head of a golf club."""


def entries_for(
    dataset: Dataset, object_name: str | None = None, without: Collection[str] = ()
) -> list[Entry]:
    """The labelled recordings of one object, but for some participants'.

    ``object_name`` may be left out where the dataset has one object. Raises DatasetError.
    """
    labelled = [entry for entry in dataset.entries if entry.object is not None]
    objects = sorted({entry.object for entry in labelled if entry.object is not None})
    if object_name is None:
        if len(objects) != 1:
            raise DatasetError(
                f"{dataset.folder} has {len(objects)} labelled objects; "
                + (f"choose with --object: {', '.join(objects)}" if objects else "none to learn")
            )
        object_name = objects[0]
    chosen = [e for e in labelled if e.object == object_name and e.participant not in without]
    if not chosen:
        raise DatasetError(
            f"{dataset.folder} has no labelled recording of {object_name!r} left; "
            f"there are: {', '.join(objects)}"
        )
    return chosen


def train(dataset: Dataset, entries: Collection[Entry]) -> Model:
    """Learn from recordings of one object; raises DatasetError or InhandError."""
    first = next(iter(entries))
    if first.object is None:
        raise DatasetError(f"{first.file} is not labelled")
    shape = dataset.shape(first.object)
    sequences = [checked_sequence(dataset, entry) for entry in entries]
    try:
        mapping = learn(sequences, shape.mirror_normal)
    except UnusableSequenceError as error:
        raise DatasetError(f"{dataset.folder}: {error}") from None
    return Model(first.interaction, shape, mapping, find_viewpoints(shape))


def checked_sequence(dataset: Dataset, entry: Entry) -> LabelledSequence:
    """A recording for training; raises DatasetError for one that cannot be meant."""
    sequence = labelled_sequence(dataset, entry)
    if not np.isfinite(sequence.translations).any():
        raise DatasetError(
            f"{entry.file} has no label of {entry.object!r}: label it, or take it out of "
            "dataset.toml"
        )
    steps = np.linalg.norm(np.diff(sequence.translations, axis=0), axis=1)
    jumps = np.flatnonzero(steps * entry.frame_rate > FASTEST_M_PER_S)
    if len(jumps):
        raise DatasetError(
            f"{entry.file}: the label jumps by {steps[jumps[0]]:.2f} m after frame {jumps[0]}: "
            "mend that label"
        )
    return sequence
