"""Learns a recogniser, and a model for each of its actions, from the recordings of a dataset."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from inhand_tracker.model.model import Model
from inhand_tracker.recognition.recogniser import Recogniser

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.evaluation.fold_model import learn_fold_model
from inhand_lab.evaluation.folds import Fold
from inhand_lab.training.presence_training import learn_presence
from inhand_lab.training.recogniser_training import train_recogniser


class TaughtCascade(NamedTuple):
    """A recogniser, and a model for each of its actions, in their order."""

    recogniser: Recogniser
    models: list[Model]


def labelled_entries(dataset: Dataset) -> list[DatasetEntry]:
    """Choose the recordings with a labelled object; raises DatasetError where there are none."""
    entries = [entry for entry in dataset.entries if entry.object is not None]
    if not entries:
        raise DatasetError(
            f"{dataset.folder} has no labelled recording: only recognition alone can be measured "
            "on it (--alone)"
        )
    return entries


def learn_cascade(
    dataset: Dataset, entries: Sequence[DatasetEntry], *, images: bool = True
) -> TaughtCascade:
    """Learn all that a cascade needs; without ``images`` no boundaries, colours or presence.

    Raises DatasetError or RecordingError.
    """
    recogniser = train_recogniser(dataset, entries)
    models = learn_models(dataset, entries, recogniser.actions, images=images)
    if images:
        presence = learn_presence(dataset, entries, recogniser.actions, models)
        recogniser = replace(recogniser, presence=presence)
    return TaughtCascade(recogniser, models)


def learn_models(
    dataset: Dataset,
    entries: Sequence[DatasetEntry],
    actions: Sequence[str],
    *,
    images: bool = True,
) -> list[Model]:
    """Learn a model for each of the actions; raises DatasetError or RecordingError."""
    folds = [
        Fold(action, (), tuple(entry for entry in entries if entry.interaction == action))
        for action in actions
    ]
    return [learn_fold_model(dataset, fold, images=images, fused=True) for fold in folds]
