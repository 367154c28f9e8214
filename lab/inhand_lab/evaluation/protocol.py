"""Evaluation by the protocol of Darby et al. 2014, section 6: unseen people, every method.

All trackers of a fold step together through its recordings, so that images are decoded once. The
trackers get bodies and images; the labels meet their poses only in ``scoring``.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import product
from typing import Literal

import numpy as np
from inhand_tracker.mapping.learning import LabelledSequence, UnusableSequenceError, learn
from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.methods.registry import METHODS, AnyTerm, MethodName, new_tracker
from inhand_tracker.model.model import Model
from inhand_tracker.prior.learning import learn_prior
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import Viewpoints, find_viewpoints
from inhand_tracker.sight.appearance import learn_appearance
from inhand_tracker.wire.conversion import Need

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.observations import track_together
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.evaluation.folds import Fold
from inhand_lab.evaluation.pose_errors import ErrorGauge
from inhand_lab.evaluation.scoring import Judge, Score
from inhand_lab.training.appearance_samples import appearance_samples
from inhand_lab.training.checks import check_hands
from inhand_lab.training.model_training import checked_sequence
from inhand_lab.workers import in_processes

Terms = tuple[AnyTerm, ...] | Literal["own"]
"""What of an image weighs; ``own``: what usually does in each method."""


@dataclass(frozen=True)
class Candidate:
    """A tracker that is evaluated: its method, the terms of its likelihood, and its seed."""

    method: MethodName
    terms: Terms = "own"
    seed: int = 0

    def chosen_terms(self) -> tuple[AnyTerm, ...]:
        """What of an image weighs."""
        return METHODS[self.method].usual_terms if self.terms == "own" else self.terms

    def needs(self) -> tuple[Need, ...]:
        """What of a frame must be decoded for it."""
        return METHODS[self.method].needs(self.chosen_terms())


@dataclass(frozen=True)
class Trial:
    """A candidate's score on one recording."""

    candidate: Candidate
    interaction: str
    participant: str
    recording: str
    score: Score


@dataclass(frozen=True)
class Protocol:
    """Every method with every choice of terms and every seed, on every fold."""

    trained: Dataset
    tested: Dataset
    folds: tuple[Fold, ...]
    methods: tuple[MethodName, ...]
    terms: tuple[Terms, ...]
    seeds: int

    def candidates(self) -> list[Candidate]:
        """All trackers that are compared."""
        return [
            Candidate(method, terms, seed)
            for terms, method, seed in product(self.terms, self.methods, range(self.seeds))
        ]

    def trials(self) -> int:
        """How many recordings are tracked, each time that one is."""
        return len(self.candidates()) * sum(len(fold.tested) for fold in self.folds)


def evaluate(
    protocol: Protocol, processes: int, on_progress: Callable[[], None] = lambda: None
) -> list[Trial]:
    """Try every candidate on every recording; ``on_progress`` is called once a trial.

    Raises DatasetError or RecordingError.
    """
    tasks = [replace(protocol, folds=(part,)) for part in _parts(protocol.folds, processes)]

    def count(trials: list[Trial]) -> None:
        for _ in trials:
            on_progress()

    done = in_processes(_evaluate_fold, tasks, processes, count)
    return [trial for trials in done for trial in trials]


def fold_model(trained: Dataset, fold: Fold, *, images: bool, fused: bool) -> Model:
    """What is learned for a fold; without images no boundaries are looked for, and a prior and an
    appearance for ``fusion`` alone.

    Raises DatasetError or RecordingError.
    """
    shape = _shape(trained, fold)
    sequences = [_sequence(trained, entry) for entry in fold.trained]
    check_hands(fold.trained, sequences)
    try:
        mapping = learn(sequences, shape.mirror_normal)
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


def _evaluate_fold(protocol: Protocol) -> list[Trial]:
    (fold,) = protocol.folds
    model = fold_model(
        protocol.trained,
        fold,
        images=any(protocol.terms),
        fused=any(METHODS[name].learns_prior for name in protocol.methods),
    )
    gauge = ErrorGauge(model.shape)
    return [
        Trial(candidate, fold.interaction, entry.participant, entry.file, score)
        for entry in fold.tested
        for candidate, score in _evaluate_recording(protocol, model, gauge, entry)
    ]


def _evaluate_recording(
    protocol: Protocol, model: Model, gauge: ErrorGauge, entry: DatasetEntry
) -> Iterator[tuple[Candidate, Score]]:
    path = protocol.tested.path(entry)
    frames = load_frames(path, entry.object)
    candidates = protocol.candidates()
    trackers = [tracker_of(candidate, model, entry) for candidate in candidates]
    needs = {need for candidate in candidates for need in candidate.needs()}
    joints, tracks = track_together(trackers, path, frames, needs)
    judge = Judge(frames, joints, gauge)
    for candidate, track in zip(candidates, tracks, strict=True):
        score = judge.score(track)
        if score is None:
            raise DatasetError(
                f"{entry.file}: no frame has both a pose and a label of {entry.object!r}: label "
                "it, or take it out of dataset.toml"
            )
        yield candidate, score


def tracker_of(candidate: Candidate, model: Model, entry: DatasetEntry) -> ObjectTracker:
    """A candidate's tracker for one recording."""
    return new_tracker(
        model,
        candidate.method,
        left_handed=entry.handedness == "left",
        terms=candidate.chosen_terms(),
        seed=candidate.seed,
    )


def _parts(folds: Sequence[Fold], processes: int) -> list[Fold]:
    """The folds, each in several where there are fewer than processes."""
    shares = -(-processes // len(folds))
    parts = []
    for fold in folds:
        dealt = [fold.tested[first::shares] for first in range(min(shares, len(fold.tested)))]
        parts += [replace(fold, tested=tested) for tested in dealt]
    return parts


def _shape(dataset: Dataset, fold: Fold) -> ObjectShape:
    name = fold.trained[0].object
    if name is None:
        raise DatasetError(f"{fold.trained[0].file} is not labelled")
    return dataset.shape(name)


# Folds share recordings, and the objects, whose boundaries take seconds to find.
@lru_cache(maxsize=16)
def _sequence(dataset: Dataset, entry: DatasetEntry) -> LabelledSequence:
    return checked_sequence(dataset, entry)


@lru_cache(maxsize=32)
def _viewpoints(dataset: Dataset, name: str) -> Viewpoints:
    return find_viewpoints(dataset.shape(name))
