"""Learning how an object is held: which part of the body carries it most steadily."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from inhand_tracker.body.holders import HOLDERS, find_holder
from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.prior.calibration import calibration_of, widened, widening_of
from inhand_tracker.prior.combination import rotation_error
from inhand_tracker.prior.hold import Hold, rotation_near
from inhand_tracker.prior.parameters import PriorLearningParameters
from inhand_tracker.prior.prediction import Prediction
from inhand_tracker.prior.samples import Samples


def learn_hold(
    samples: Samples, spread: Array, units: int, parameters: PriorLearningParameters
) -> Hold | None:
    """Learn the hold from samples of ``units`` people; ``spread`` (3, 3) is that of the marked
    vertices.

    The holder, by itself or with the other hand, is the one by which the others' mean says best
    where each group that is held out has the object. None where fewer than two groups carry it.
    """
    root = np.asarray(np.linalg.cholesky(spread + 1e-9 * np.eye(3)), np.float64)
    rows = np.flatnonzero(carried_frames(samples, root, parameters))
    if len(np.unique(samples.groups[rows])) < 2:
        return None
    spaced = np.linspace(0, len(rows) - 1, parameters.landmarks).round().astype(np.int64)
    carried = samples.take(rows[np.unique(spaced)])
    trials = [trial for number in range(len(HOLDERS)) for trial in _trials(carried, number)]
    scores = [trial.score(root) * trial.caution(parameters) for trial in trials]
    return trials[int(np.argmin(scores))].hold(units)


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
    """A way to hold it, tried on samples (T,) in which the object is carried: what is predicted of
    groups that are held out."""

    samples: Samples
    mean: Hold
    held_out: Prediction

    def score(self, root: Array) -> float:
        """Root mean square, in metres, of the marked vertices' held-out errors."""
        moved = self.held_out.centre - self.samples.centres
        turned = (self.held_out.rotation - self.samples.rotations) @ root
        square = np.square(moved).sum(axis=1) + np.square(turned).sum(axis=(1, 2))
        return float(np.sqrt(square.mean()))

    def caution(self, parameters: PriorLearningParameters) -> float:
        """Factor on the score, by how readily such a hold seems steady that is none."""
        if HOLDERS[self.mean.holder].upright:
            return parameters.upright_holder_ratio
        return 1.0 if self.mean.holder == 0 else parameters.other_holder_ratio

    def hold(self, units: int) -> Hold:
        """The mean of all samples, with the calibrated covariance of the held-out errors of
        ``units`` people."""
        errors = _in_object(self.held_out, self.samples)
        least = _LEAST_VARIANCE * np.eye(6)
        covariance = widened(errors.T @ errors / len(errors) + least, widening_of(units))
        at_each = np.broadcast_to(covariance, (len(errors), 6, 6))
        calibration = calibration_of(at_each, errors, units)
        return replace(self.mean, covariance=calibration * covariance + least)


def _trials(samples: Samples, holder: int) -> Iterator[_Trial]:
    """Try a holder by itself, and with the other hand where there is one."""
    alone = _trial(samples, holder)
    yield alone
    if HOLDERS[holder].other is not None:
        turned = _in_object(alone.held_out, samples)[:, 3:]
        _, _, ways = find_holder(samples.anchors, holder)
        apart = _turned_back(samples.rotations, ways)
        off = [apart[rows] - apart[~rows].mean(axis=0) for rows in _held_out(samples)]
        # Of the likelihood of a rotation and of the other hand's place, both normal.
        variance = np.square(np.concatenate(off)).mean() + _LEAST_VARIANCE
        surer = 2.0 * float(np.square(turned).mean()) / variance
        yield _trial(samples, holder, surer)


def _trial(samples: Samples, holder: int, surer: float = 0.0) -> _Trial:
    """Try a holder; the other hand's place is so much ``surer`` than the rotation, in 1/m²."""
    centres, turns = np.empty_like(samples.centres), np.empty_like(samples.rotations)
    for rows in _held_out(samples):
        others = _mean_hold(samples.take(np.flatnonzero(~rows)), holder, surer)
        predicted = others.of(samples.take(np.flatnonzero(rows)).anchors)
        centres[rows], turns[rows] = predicted.centre, predicted.rotation
    nothing = np.zeros((len(centres), 6, 6))
    return _Trial(samples, _mean_hold(samples, holder, surer), Prediction(centres, turns, nothing))


def _held_out(samples: Samples) -> Iterator[Flags]:
    """Flag the samples (T,) of each group in turn."""
    for group in np.unique(samples.groups):
        yield samples.groups == group


def _mean_hold(samples: Samples, holder: int, surer: float) -> Hold:
    """The mean hold of samples, as yet without a covariance."""
    origins, axes, ways = find_holder(samples.anchors, holder)
    turns = np.swapaxes(axes, 1, 2) @ samples.rotations
    grips = _turned_back(samples.rotations, origins - samples.centres)
    pulls = surer * _turned_back(samples.rotations, ways)
    rotation = rotation_near(turns.mean(axis=0))
    return Hold(holder, rotation, grips.mean(axis=0), pulls.mean(axis=0), np.zeros((6, 6)))


def _in_object(predicted: Prediction, samples: Samples) -> Array:
    """Errors (T, 6) of predictions, in the axes of the predicted objects."""
    moved = predicted.centre - samples.centres
    turned = rotation_error(predicted.rotation, samples.rotations)
    return np.concatenate(
        [_turned_back(predicted.rotation, one) for one in (moved, turned)], axis=1
    )


def _turned_back(turns: Array, vectors: Array) -> Array:
    """Vectors (T, 3) in the axes of rotations (T, 3, 3)."""
    return np.einsum("tji,tj->ti", turns, vectors)


_LEAST_VARIANCE = 1e-6
"""Variance, of a millimetre and a milliradian, that a hold has at the least: joints are never known
better."""
