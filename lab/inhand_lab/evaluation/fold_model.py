"""Learns the model that a fold's recordings are tracked with, from its other recordings."""

from functools import lru_cache

import numpy as np
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.learning import UnusableSequenceError, learn
from inhand_tracker.model.model import Model
from inhand_tracker.prior.learning import learn_prior
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import Viewpoints, find_viewpoints
from inhand_tracker.sight.appearance import learn_appearance

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.evaluation.folds import Fold
from inhand_lab.training.absent_joints import absent_joints
from inhand_lab.training.appearance_samples import appearance_samples
from inhand_lab.training.model_adaptation import as_own
from inhand_lab.training.model_training import checked_sequence, checked_shape
from inhand_lab.training.recording_checks import check_hands
from inhand_lab.training.rotation_checks import check_rotations


def learn_fold_model(
    trained: Dataset, fold: Fold, *, images: bool, fused: bool, tested: Dataset | None = None
) -> Model:
    """Learn from the recordings of ``trained`` that a fold does not test, and from those of
    ``tested`` that it adds, as the user's own.

    Boundaries are looked for with ``images`` only; a prior is learned, and with images an
    appearance, for a ``fused`` method only. Raises DatasetError or RecordingError.
    """
    shape = _shape(trained, fold)
    sequences = [_sequence(trained, entry) for entry in fold.trained]
    sequences += [as_own(_sequence(tested or trained, entry)) for entry in fold.added]
    entries = (*fold.trained, *fold.added)
    check_hands(entries, sequences)
    absent = absent_joints(entries, sequences)
    sequences = [sequence.with_stand_ins(absent) for sequence in sequences]
    check_rotations(entries, sequences, shape.mirror_normal)
    try:
        mapping = learn(sequences, shape.mirror_normal, absent_joints=absent)
    except UnusableSequenceError as error:
        raise DatasetError(f"{trained.folder}, {fold.interaction}: {error}") from None
    viewpoints = Viewpoints(np.eye(3), np.zeros((3, 1, 3)))
    appearance = prior = None
    if images:
        viewpoints = _viewpoints(trained, shape.name)
    if fused:
        prior = learn_prior(sequences, shape)
    if fused and images:
        appearance = learn_appearance(shape, appearance_samples(trained, fold.trained))
    return Model(fold.interaction, shape, mapping, viewpoints, appearance, prior)


def _shape(dataset: Dataset, fold: Fold) -> ObjectShape:
    name = fold.trained[0].object
    if name is None:
        raise DatasetError(f"{fold.trained[0].file} is not labelled")
    return checked_shape(dataset, name)


# Folds share recordings, and the objects, whose boundaries take seconds to find.
@lru_cache(maxsize=16)
def _sequence(dataset: Dataset, entry: DatasetEntry) -> LabelledSequence:
    return checked_sequence(dataset, entry)


@lru_cache(maxsize=32)
def _viewpoints(dataset: Dataset, name: str) -> Viewpoints:
    return find_viewpoints(dataset.shape(name))
