"""Evaluation by the protocol of Darby et al. 2014, section 6: leave one participant out.

The tracker gets bodies and images; the labels meet its estimates only in ``score``.
"""

from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from inhand_runtime.pixels import decode_grey
from inhand_tracker import rotations
from inhand_tracker.conversion import joints_of
from inhand_tracker.estimate import Estimate, vertex_error
from inhand_tracker.following import Follower
from inhand_tracker.learning import LabelledSequence, learn
from inhand_tracker.methods import METHODS
from inhand_tracker.model_file import Model
from inhand_tracker.tracking import Image, Tracker
from inhand_tracker.viewpoints import Viewpoints, find_viewpoints
from numpy.typing import NDArray

from inhand_lab.dataset import (
    Dataset,
    DatasetError,
    Entry,
    Frame,
    iterate_pixels,
    load_camera,
    load_frames,
)
from inhand_lab.training import checked_sequence

Array = NDArray[np.float64]

LOSS_M = 0.20


@dataclass(frozen=True)
class Fold:
    """What is tested, and the recordings that are learned from."""

    interaction: str
    tested: tuple[Entry, ...]
    trained: tuple[Entry, ...]


@dataclass(frozen=True)
class SequenceScore:
    """Errors of one recording by one method and seed; means over its labelled frames."""

    method: str
    interaction: str
    participant: str
    seed: int
    frames: int
    vertex_error_m: float
    translation_m: float
    rotation_rad: float
    recovery_s: float | None


def leave_one_out(dataset: Dataset) -> list[Fold]:
    """A fold a participant, or a recording where an interaction has one participant only."""
    folds = []
    for interaction in dataset.interactions():
        entries = [e for e in dataset.entries if e.interaction == interaction and e.object]
        participants = sorted({entry.participant for entry in entries})
        groups = (
            [[e for e in entries if e.participant == participant] for participant in participants]
            if len(participants) > 1
            else [[entry] for entry in entries]
        )
        for group in groups:
            rest = tuple(entry for entry in entries if entry not in group)
            folds.append(Fold(interaction, tuple(group), rest))
    return _checked(folds, dataset)


def train_on_one_test_on_other(trained: Dataset, tested: Dataset) -> list[Fold]:
    """A fold an interaction: all recordings of one set against all of the other."""
    folds = [
        Fold(
            interaction,
            tuple(e for e in tested.entries if e.interaction == interaction and e.object),
            tuple(e for e in trained.entries if e.interaction == interaction and e.object),
        )
        for interaction in tested.interactions()
    ]
    return _checked([fold for fold in folds if fold.trained], tested)


def evaluate(
    trained: Dataset,
    tested: Dataset,
    folds: Sequence[Fold],
    methods: Collection[str],
    seeds: int,
    *,
    images: bool,
    processes: int,
    on_progress: Callable[[], None],
) -> list[SequenceScore]:
    """Scores of every tested recording by every method and seed.

    ``on_progress`` is called once a fold. Raises DatasetError.
    """
    tasks = [(trained, tested, fold, tuple(methods), seeds, images) for fold in folds]
    scores: list[SequenceScore] = []
    if processes == 1 or len(tasks) == 1:
        for task in tasks:
            scores += _evaluate_fold(*task)
            on_progress()
        return scores
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        for result in pool.map(_evaluate_fold, *zip(*tasks, strict=True)):
            scores += result
            on_progress()
    return scores


def track_recording(
    tracker: Tracker, path: Path, frames: Sequence[Frame], *, images: bool
) -> Iterator[Estimate]:
    """A tracker's estimates for the frames of a recording, as the tracker daemon makes them."""
    camera = load_camera(path) if images else None
    pixels = iterate_pixels(path) if camera is not None else iter(())
    current = next(pixels, None)
    follower = Follower()
    for frame in frames:
        while current is not None and current.sequence < frame.sequence:
            current = next(pixels, None)
        image = None
        if camera is not None and current is not None and current.sequence == frame.sequence:
            colour = current.colour
            if colour is not None:
                image = Image(decode_grey(colour), camera.scaled_to(colour.width, colour.height))
        before = follower.person_id
        person = follower.choose(frame.people, frame.time_ns)
        if follower.person_id != before:
            tracker.restart()
        joints = None if person is None else joints_of(person)
        yield tracker.step(joints, frame.time_ns, image)


def score(
    estimates: Sequence[Estimate],
    frames: Sequence[Frame],
    marked_vertices: Array,
    frame_rate: float,
) -> tuple[int, Array, Array, Array, float | None]:
    """Frames scored, their vertex errors, translation errors (m) and turns (rad), and recovery.

    A lost object counts at the last pose that was given for it. Recovery is the mean length in
    seconds of the stretches in which the vertex error is above 20 cm; None without any.
    """
    errors, shifts, turns = [], [], []
    last: tuple[Array, Array] | None = None
    for estimate, frame in zip(estimates, frames, strict=True):
        if estimate.translation is not None and estimate.rotation is not None:
            last = estimate.translation, estimate.rotation
        if frame.label is None or frame.label.camera_from_object is None or last is None:
            continue
        truth = frame.label.camera_from_object
        translation, rotation = np.array(truth.translation), np.array(truth.rotation)
        errors.append(float(vertex_error(last, (translation, rotation), marked_vertices)))
        shifts.append(float(np.linalg.norm(last[0] - translation)))
        turns.append(float(rotations.angle_between(last[1], rotation)))
    return (
        len(errors),
        np.array(errors),
        np.array(shifts),
        np.array(turns),
        _recovery(np.array(errors), frame_rate),
    )


def summarise(scores: Sequence[SequenceScore]) -> dict[str, Any]:
    """``{METHOD: {vertex_error_cm, sd, interactions: {I: …}}}`` in cm and degrees.

    A participant's error is the mean over its recordings and seeds; a cell is the mean and the
    standard deviation over participants; a method's figure is the mean over interactions.
    """
    summary: dict[str, Any] = {}
    for method in dict.fromkeys(s.method for s in scores):
        cells = {}
        of_method = [s for s in scores if s.method == method]
        for interaction in dict.fromkeys(s.interaction for s in of_method):
            cells[interaction] = _cell([s for s in of_method if s.interaction == interaction])
        summary[method] = {
            "vertex_error_cm": _mean(cell["vertex_error_cm"] for cell in cells.values()),
            "sd": _mean(cell["sd"] for cell in cells.values()),
            "interactions": cells,
        }
    return summary


def _cell(scores: Sequence[SequenceScore]) -> dict[str, float | None]:
    participants = sorted({s.participant for s in scores})
    errors = [
        _mean(s.vertex_error_m for s in scores if s.participant == participant)
        for participant in participants
    ]
    if len(participants) == 1:
        errors = [s.vertex_error_m for s in scores]
    recoveries = [s.recovery_s for s in scores if s.recovery_s is not None]
    return {
        "vertex_error_cm": 100.0 * _mean(errors),
        "sd": 100.0 * float(np.std(errors)),
        "rotation_deg": float(np.degrees(_mean(s.rotation_rad for s in scores))),
        "translation_cm": 100.0 * _mean(s.translation_m for s in scores),
        "recovery_s": _mean(recoveries) if recoveries else None,
    }


def _evaluate_fold(
    trained: Dataset,
    tested: Dataset,
    fold: Fold,
    methods: tuple[str, ...],
    seeds: int,
    images: bool,
) -> list[SequenceScore]:
    name = fold.trained[0].object
    if name is None:
        raise DatasetError(f"{fold.trained[0].file} is not labelled")
    shape = trained.shape(name)
    sequences: list[LabelledSequence] = [checked_sequence(trained, e) for e in fold.trained]
    viewpoints = find_viewpoints(shape) if images else Viewpoints(np.eye(3), np.zeros((3, 1, 3)))
    model = Model(fold.interaction, shape, learn(sequences, shape.mirror_normal), viewpoints)
    scores = []
    for entry in fold.tested:
        path = tested.path(entry)
        frames = load_frames(path, entry.object)
        for method in methods:
            for seed in range(seeds):
                tracker = Tracker(
                    model, METHODS[method], left_handed=entry.handedness == "left", seed=seed
                )
                estimates = list(track_recording(tracker, path, frames, images=images))
                count, errors, shifts, turns, recovery = score(
                    estimates, frames, shape.marked_vertices, entry.frame_rate
                )
                if count == 0:
                    raise DatasetError(f"{entry.file}: no frame has both a pose and a label")
                scores.append(
                    SequenceScore(
                        method,
                        fold.interaction,
                        entry.participant,
                        seed,
                        count,
                        float(errors.mean()),
                        float(shifts.mean()),
                        float(turns.mean()),
                        recovery,
                    )
                )
    return scores


def _checked(folds: list[Fold], dataset: Dataset) -> list[Fold]:
    if not folds:
        raise DatasetError(f"{dataset.folder} has no labelled interaction to evaluate")
    for fold in folds:
        if len(fold.trained) < 2:
            raise DatasetError(
                f"{dataset.folder}: {fold.interaction} leaves {len(fold.trained)} recordings to "
                "learn from, and two are the least: add participants"
            )
    return folds


def _recovery(errors: Array, frame_rate: float) -> float | None:
    lost = np.concatenate(([False], errors > LOSS_M, [False]))
    edges = np.flatnonzero(np.diff(lost.astype(int)))
    stretches = edges[1::2] - edges[::2]
    return float(stretches.mean() / frame_rate) if len(stretches) else None


def _mean(values: Any) -> float:
    return float(np.mean(list(values)))
