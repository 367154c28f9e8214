"""Evaluation by the protocol of Darby et al. 2014, section 6: unseen people, every method.

All trackers of a fold step together through its recordings, so that images are decoded once. The
trackers get bodies and images; the labels meet their poses only in ``scoring``.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Literal

import numpy as np
from inhand_tracker.body.skeleton import PELVIS_JOINTS, has_pelvis
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.methods.registry import METHODS, AnyTerm, MethodName, new_tracker
from inhand_tracker.model.model import Model
from inhand_tracker.wire.conversion import Need

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.joint_names import named_joints
from inhand_lab.datasets.observations import track_together
from inhand_lab.datasets.stretches import entry_frames, entry_name, stretches_note
from inhand_lab.evaluation.fold_model import learn_fold_model
from inhand_lab.evaluation.folds import Fold
from inhand_lab.evaluation.pose_errors import ErrorGauge
from inhand_lab.evaluation.scoring import Judge, Score
from inhand_lab.training.recording_checks import check_facing
from inhand_lab.workers import in_processes

Terms = tuple[AnyTerm, ...] | Literal["own"]
"""The terms of an image's likelihood; ``own`` are those that each method usually weighs."""


@dataclass(frozen=True)
class Candidate:
    """A tracker that is evaluated: its method, the terms of its likelihood, and its seed."""

    method: MethodName
    terms: Terms = "own"
    seed: int = 0

    def chosen_terms(self) -> tuple[AnyTerm, ...]:
        """Return the terms that it weighs, those of its method where they are its own."""
        return METHODS[self.method].usual_terms if self.terms == "own" else self.terms

    def needs(self) -> tuple[Need, ...]:
        """Return the parts of a frame that must be decoded for it."""
        return METHODS[self.method].needs(self.chosen_terms())

    def new_tracker(self, model: Model, entry: DatasetEntry) -> ObjectTracker:
        """Make its tracker for one recording."""
        return new_tracker(
            model,
            self.method,
            left_handed=entry.handedness == "left",
            terms=self.chosen_terms(),
            seed=self.seed,
        )


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
        """Return all trackers that are compared."""
        return [
            Candidate(method, terms, seed)
            for terms, method, seed in product(self.terms, self.methods, range(self.seeds))
        ]

    def trials(self) -> int:
        """Return the number of recordings tracked, counted for every candidate."""
        return len(self.candidates()) * sum(len(fold.tested) for fold in self.folds)

    def notes(self) -> list[str]:
        """Return what has to be known of the figures, a sentence each."""
        notes = [stretches_note(fold.trained) for fold in self.folds]
        return [note for note in dict.fromkeys(notes) if note]

    def learn(self, fold: Fold, *, images: bool) -> Model:
        """Learn what the methods need for a fold; raises DatasetError or RecordingError."""
        fused = any(METHODS[name].learns_prior for name in self.methods)
        return learn_fold_model(self.trained, fold, images=images, fused=fused, tested=self.tested)


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


def _evaluate_fold(protocol: Protocol) -> list[Trial]:
    (fold,) = protocol.folds
    model = protocol.learn(fold, images=any(protocol.terms))
    gauge = ErrorGauge(model.shape)
    return [
        Trial(candidate, fold.interaction, entry.participant, entry_name(entry), score)
        for entry in fold.tested
        for candidate, score in _evaluate_recording(protocol, model, gauge, entry)
    ]


def _evaluate_recording(
    protocol: Protocol, model: Model, gauge: ErrorGauge, entry: DatasetEntry
) -> Iterator[tuple[Candidate, Score]]:
    path = protocol.tested.path(entry)
    frames = entry_frames(protocol.tested, entry)
    candidates = protocol.candidates()
    trackers = [candidate.new_tracker(model, entry) for candidate in candidates]
    needs = {need for candidate in candidates for need in candidate.needs()}
    joints, tracks = track_together(trackers, path, frames, needs)
    check_facing(entry, joints)
    judge = Judge(frames, joints, gauge)
    for candidate, track in zip(candidates, tracks, strict=True):
        score = judge.score(track)
        if score is None:
            raise _unscored(entry, model, joints)
        yield candidate, score


def _unscored(entry: DatasetEntry, model: Model, joints: Array) -> DatasetError:
    """Say why nothing could be scored in a recording whose joints (T, 20, 3) were seen."""
    if not model.mapping.absent_joints and not any(map(has_pelvis, joints)):
        seen = np.asarray(np.asarray(np.isfinite(joints).all(axis=2)).any(axis=0))
        lacking = [joint for joint in PELVIS_JOINTS.tolist() if not seen[joint]]
        never = named_joints(lacking or PELVIS_JOINTS.tolist())
        return DatasetError(
            f"{entry.file} never shows a pelvis ({never}), and what was learned from does: learn "
            "from recordings that lack the same joints"
        )
    return DatasetError(
        f"{entry.file}: no frame has both a pose and a label of {entry.object!r}: label it, or "
        "take it out of dataset.toml"
    )


def _parts(folds: Sequence[Fold], processes: int) -> list[Fold]:
    """Deal the recordings of each fold into several where there are fewer folds than processes."""
    shares = -(-processes // len(folds))
    parts = []
    for fold in folds:
        dealt = [fold.tested[first::shares] for first in range(min(shares, len(fold.tested)))]
        parts += [replace(fold, tested=tested) for tested in dealt]
    return parts
