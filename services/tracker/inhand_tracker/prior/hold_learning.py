"""Learning how an object is held: which part of the body carries it most steadily."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from inhand_tracker.body.holders import HOLDERS, find_holder
from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.prior.calibration import calibration_of, widening_of
from inhand_tracker.prior.combination import rotation_error, vertex_products, widened
from inhand_tracker.prior.hold import Hold, rotation_near
from inhand_tracker.prior.parameters import PriorLearningParameters
from inhand_tracker.prior.prediction import Prediction
from inhand_tracker.prior.samples import Samples

LEAST_VARIANCE = 1e-6
"""Variance, of a millimetre and a milliradian, that a hold has at the least: joints are never known
better."""


def learn_hold(
    samples: Samples,
    landmarks: Samples,
    regressed: Array,
    spread: Array,
    units: int,
    parameters: PriorLearningParameters,
) -> Hold | None:
    """Learn the hold from samples of ``units`` people; ``spread`` (3, 3) is that of the marked
    vertices, ``regressed`` (L, 6) the regressions' held-out errors at the prior's landmarks, in the
    camera frame, in metres and radians.

    The holder, by itself or with the other hand, is the one by which the others' mean says best
    where each group that is held out has the object. None where fewer than two groups carry it.
    """
    root = np.asarray(np.linalg.cholesky(spread + 1e-9 * np.eye(3)), np.float64)
    rows = np.flatnonzero(carried_frames(samples, root, parameters))
    if len(np.unique(samples.groups[rows])) < 2:
        return None
    spaced = np.linspace(0, len(rows) - 1, parameters.landmarks).round().astype(np.int64)
    carried = samples.take(rows[np.unique(spaced)])
    trials = [
        trial for number in range(len(HOLDERS)) for trial in _trials(carried, number, parameters)
    ]
    scores = [trial.score(root) * trial.caution(parameters) for trial in trials]
    best = trials[int(np.argmin(scores))]
    held = best.tried_on(landmarks)
    turned = rotation_error(held.rotation, landmarks.rotations)
    to_hold = np.concatenate((held.centre - landmarks.centres, turned), axis=1) - regressed
    leanings = [vertex_products(to_hold, other, spread) for other in (-regressed, to_hold)]
    return replace(best.hold(units), leanings=np.stack(leanings, axis=1))


def carried_frames(samples: Samples, root: Array, parameters: PriorLearningParameters) -> Flags:
    """Flag (N,) the samples in which somebody carries the object: it moves, or pauses for a moment.

    ``root`` (3, 3) is the Cholesky root of the spread of the marked vertices.
    """
    carried = np.zeros(len(samples.times), bool)
    for number in np.unique(samples.sequences):
        rows = np.flatnonzero(samples.sequences == number)
        times = samples.times[rows]
        moving = times[_moving(samples.take(rows), root, parameters)]
        if len(moving) > 0:
            after = np.searchsorted(moving, times)
            before = np.searchsorted(moving, times, side="right") - 1
            inside = (before >= 0) & (after < len(moving))
            pause_s = moving[after[inside]] - moving[before[inside]]
            carried[rows[inside]] = pause_s < parameters.carried_pause_s
    return carried


def _moving(samples: Samples, root: Array, parameters: PriorLearningParameters) -> Flags:
    """Flag the samples (T,) of a sequence before and after which the object moves."""
    # Times are multiples of a frame's: the window's own end must not hang on rounding.
    window_s = parameters.carried_window_s + 1e-6
    first = np.searchsorted(samples.times, samples.times - window_s)
    last = np.searchsorted(samples.times, samples.times + window_s) - 1
    middle = np.arange(len(samples.times))
    flags = np.full(len(middle), True)
    for start, end in ((first, middle), (middle, last)):
        moved = samples.centres[end] - samples.centres[start]
        turned = (samples.rotations[end] - samples.rotations[start]) @ root
        square = np.square(moved).sum(axis=1) + np.square(turned).sum(axis=(1, 2))
        flags &= square > parameters.carried_way_m**2
    return flags


@dataclass(frozen=True)
class _Trial:
    """A way to hold it, tried on samples (T,) in which the object is carried: by a holder, and with
    the other hand's place so much ``surer`` than the rotation, in 1/m²."""

    samples: Samples
    holder: int
    surer: float = 0.0

    @cached_property
    def held_out(self) -> Prediction:
        """What is predicted of groups that are held out."""
        return self.tried_on(self.samples)

    def tried_on(self, samples: Samples) -> Prediction:
        """Predict samples, each by the mean of groups other than its own; without covariances."""
        centres, turns = np.empty_like(samples.centres), np.empty_like(samples.rotations)
        for group in np.unique(samples.groups):
            rows = samples.groups == group
            hold = self.mean(self.samples.groups != group)
            predicted = hold.of(samples.take(np.flatnonzero(rows)).anchors)
            centres[rows], turns[rows] = predicted.centre, predicted.rotation
        return Prediction(centres, turns, np.zeros((len(centres), 6, 6)))

    def mean(self, rows: Flags) -> Hold:
        """The mean hold of some samples, as yet without a covariance."""
        samples = self.samples.take(np.flatnonzero(rows))
        weights = samples.weights()
        origins, axes, ways = find_holder(samples.anchors, self.holder)
        turns = np.swapaxes(axes, 1, 2) @ samples.rotations
        grips = _turned_back(samples.rotations, origins - samples.centres)
        return Hold(
            self.holder,
            rotation_near(np.einsum("t,tij->ij", weights, turns)),
            weights @ grips,
            self.surer * (weights @ _turned_back(samples.rotations, ways)),
            np.zeros((6, 6)),
            np.empty((0, 2)),
        )

    def score(self, root: Array) -> float:
        """Root mean square, in metres, of the marked vertices' held-out errors."""
        moved = self.held_out.centre - self.samples.centres
        turned = (self.held_out.rotation - self.samples.rotations) @ root
        square = np.square(moved).sum(axis=1) + np.square(turned).sum(axis=(1, 2))
        return float(np.sqrt(self.samples.weights() @ square))

    def caution(self, parameters: PriorLearningParameters) -> float:
        """Factor on the score, by how readily such a hold seems steady that is none."""
        if HOLDERS[self.holder].upright:
            return parameters.upright_holder_ratio
        return 1.0 if self.holder == 0 else parameters.other_holder_ratio

    def errors(self) -> Array:
        """Held-out errors (T, 6), in the axes of the predicted objects, in metres and radians."""
        return _errors_in_object(self.held_out.centre, self.held_out.rotation, self.samples)

    def hold(self, units: int) -> Hold:
        """The mean of all samples, with the calibrated covariance of the held-out errors of
        ``units`` people."""
        errors = self.errors()
        least = LEAST_VARIANCE * np.eye(6)
        weighted = self.samples.weights()[:, None] * errors
        covariance = widened(errors.T @ weighted + least, widening_of(units))
        at_each = np.broadcast_to(covariance, (len(errors), 6, 6))
        calibration = calibration_of(at_each, errors, units)
        everybody = self.mean(np.full(len(errors), True))
        return replace(everybody, covariance=calibration * covariance + least)


def _trials(samples: Samples, holder: int, parameters: PriorLearningParameters) -> Iterator[_Trial]:
    """Try a holder by itself, and with the other hand where that is on the object as well."""
    alone = _Trial(samples, holder)
    yield alone
    if HOLDERS[holder].other is None:
        return
    _, _, ways = find_holder(samples.anchors, holder)
    places = _turned_back(samples.rotations, ways)
    # The user's own sensor may lose a hand beside the other one: many people say what both hold.
    many = (
        ~samples.own
        if len(np.unique(samples.groups[~samples.own])) > 1
        else np.full(len(samples.own), True)
    )
    usual, mean = np.empty_like(places), np.empty_like(places)
    for group in np.unique(samples.groups):
        rows = samples.groups == group
        others = places[~rows & many]
        usual[rows], mean[rows] = np.median(others, axis=0), others.mean(axis=0)
    if np.median(np.linalg.norm(places - usual, axis=1)[many]) < parameters.other_grip_m:
        # Of the likelihood of a rotation and of the other hand's place, both normal.
        turned = float(np.square(alone.errors()[many, 3:]).mean())
        variance = float(np.square((places - mean)[many]).mean()) + LEAST_VARIANCE
        yield _Trial(samples, holder, 2.0 * turned / variance)


def _errors_in_object(centres: Array, turns: Array, samples: Samples) -> Array:
    """Errors (T, 6) of predicted centres (T, 3) and rotations (T, 3, 3), in these axes."""
    moved = centres - samples.centres
    turned = rotation_error(turns, samples.rotations)
    return np.concatenate([_turned_back(turns, one) for one in (moved, turned)], axis=1)


def _turned_back(turns: Array, vectors: Array) -> Array:
    """Give vectors (T, 3) in the axes of rotations (T, 3, 3)."""
    return np.einsum("tji,tj->ti", turns, vectors)
