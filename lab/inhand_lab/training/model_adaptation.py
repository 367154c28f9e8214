"""Adapts a model, of simulated people say, by a few recordings of the user's own."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.methods.registry import DEFAULT_METHOD, new_tracker
from inhand_tracker.model.model import Model
from inhand_tracker.model.taught import TaughtRecordings
from inhand_tracker.prior.learning import learn_prior
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.sight.appearance import learn_appearance

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.joint_names import named_joints
from inhand_lab.training.absent_joints import absent_joints
from inhand_lab.training.appearance_samples import appearance_samples
from inhand_lab.training.model_training import (
    APPEARANCE,
    PRIOR,
    OnRefused,
    checked_shape,
    learned_mapping,
    read_recordings,
)
from inhand_lab.training.rotation_checks import check_rotations

SAME_M = 1e-4
"""Distance in metres within which vertices of two meshes are the same: files round."""


def adapt(
    start: Model,
    dataset: Dataset,
    entries: Sequence[DatasetEntry],
    on_step: Callable[[str], None] = lambda stage: None,
    on_refused: OnRefused | None = None,
) -> Model:
    """Learn from what a model was learned from and the user's own recordings, one at the least.

    These weigh as much as all others in how the object is held. ``on_step`` is called at each step
    of ``model_stages``, ``on_refused`` as in ``train``. Raises DatasetError or InhandError.
    """
    taught = taught_of(start)
    check_fits(start, dataset, entries)
    entries, sequences = read_recordings(dataset, entries, on_step, on_refused, fewest=1)
    absent = absent_joints(entries, sequences)
    if set(absent) != set(start.mapping.absent_joints):
        lacking = sorted(set(absent) ^ set(start.mapping.absent_joints))
        raise DatasetError(
            f"{entries[0].file} and what the model was learned from do not show the same joints: "
            f"one of them never has {named_joints(lacking)}; adapt a model of bodies like these"
        )
    own = [as_own(sequence.with_stand_ins(absent)) for sequence in sequences]
    check_rotations(entries, own, start.shape.mirror_normal)
    joined = [*taught.sequences(), *own]
    mapping = learned_mapping(dataset, joined, start.shape, absent, on_step)
    appearance = learn_appearance(start.shape, appearance_samples(dataset, entries))
    on_step(APPEARANCE)
    prior = learn_prior(joined, start.shape)
    on_step(PRIOR)
    model = replace(
        start,
        mapping=mapping,
        appearance=start.appearance if appearance is None else appearance,
        prior=prior,
        taught=TaughtRecordings.of(joined),
    )
    # Compiles, once an installation, what the start of a rig would otherwise wait for.
    new_tracker(model, DEFAULT_METHOD)
    return model


def as_own(sequence: LabelledSequence) -> LabelledSequence:
    """Mark a sequence as the user's own, of nobody who taught before, whatever their names."""
    return replace(sequence, own=True, participant=f"own {sequence.participant}")


def taught_of(model: Model) -> TaughtRecordings:
    """Return the recordings that a model was learned from; raises DatasetError where it is of a
    release that did not keep them."""
    if model.taught is None:
        raise DatasetError(
            f"the model of {model.shape.name} is of an older release, and keeps no recordings to "
            "learn from again: make it anew with `inhand train`"
        )
    return model.taught


def check_fits(model: Model, dataset: Dataset, entries: Sequence[DatasetEntry]) -> None:
    """Raise DatasetError where recordings are of another object, mesh or interaction than a
    model."""
    if not entries:
        raise DatasetError(f"{dataset.folder}: no recording is left to adapt the model by")
    name, interaction = str(entries[0].object), entries[0].interaction
    if name != model.shape.name:
        raise DatasetError(
            f"{dataset.folder} labels {name!r}, and the model is of {model.shape.name!r}: adapt a "
            "model of the same object, or choose with --object"
        )
    if interaction != model.interaction:
        raise DatasetError(
            f"{dataset.folder} shows {interaction}, and the model is of {model.interaction}: adapt "
            "a model of the same interaction, or give both one name in dataset.toml"
        )
    if not same_shape(checked_shape(dataset, name), model.shape):
        raise DatasetError(
            f"the mesh of {name!r} in {dataset.folder} is not the one that the model was learned "
            f"with: copy that one into {dataset.folder / 'objects' / name}, and label with it"
        )


def same_shape(one: ObjectShape, other: ObjectShape) -> bool:
    """Whether two shapes have the same vertices, and the same ones marked."""
    return all(
        first.shape == second.shape and np.allclose(first, second, rtol=0.0, atol=SAME_M)
        for first, second in (
            (one.vertices, other.vertices),
            (one.marked_vertices, other.marked_vertices),
        )
    )
