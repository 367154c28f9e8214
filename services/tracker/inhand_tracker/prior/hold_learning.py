"""Learning how an object is held: which part of the body carries it most steadily."""

import numpy as np

from inhand_tracker.body.holders import HOLDERS, UPRIGHT, find_holder
from inhand_tracker.body.kernels.holders import OF_A_HAND
from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.prior.calibration import calibration_of, widened, widening_of
from inhand_tracker.prior.combination import rotation_error
from inhand_tracker.prior.hold import Hold, rotation_near
from inhand_tracker.prior.parameters import PriorLearningParameters
from inhand_tracker.prior.samples import Samples


def learn_hold(
    samples: Samples, spread: Array, units: int, parameters: PriorLearningParameters
) -> Hold | None:
    """Learn the hold from samples of ``units`` people; ``spread`` (3, 3) is that of the marked
    vertices.

    The holder is the one in which the object's mean pose over the others tells best where each
    group that is held out has it. None where fewer than two groups carry the object.
    """
    root = np.asarray(np.linalg.cholesky(spread + 1e-9 * np.eye(3)), np.float64)
    rows = np.flatnonzero(carried_frames(samples, root, parameters))
    if len(np.unique(samples.groups[rows])) < 2:
        return None
    spaced = np.linspace(0, len(rows) - 1, parameters.landmarks).round().astype(np.int64)
    carried = samples.take(rows[np.unique(spaced)])
    trials = [_Trial(carried, holder) for holder in range(len(HOLDERS))]
    scores = np.array([trial.score(root) for trial in trials])
    scores[OF_A_HAND:UPRIGHT] *= parameters.other_holder_ratio
    scores[UPRIGHT:] *= parameters.upright_holder_ratio
    return trials[int(scores.argmin())].hold(units)


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


class _Trial:
    """One holder tried on samples in which the object is carried."""

    def __init__(self, samples: Samples, holder: int) -> None:
        origins, axes = find_holder(samples.anchors, holder)
        away = samples.centres - origins
        self._holder = holder
        self._samples = samples
        self._places = np.einsum("tji,tj->ti", axes, away) / samples.heights[:, None]
        self._turns = np.swapaxes(axes, 1, 2) @ samples.rotations
        self._held_out_places = np.empty_like(self._places)
        self._held_out_turns = np.empty_like(self._turns)
        for group in np.unique(samples.groups):
            rows = samples.groups == group
            self._held_out_places[rows], self._held_out_turns[rows] = self._mean(~rows)

    def _mean(self, rows: Flags) -> tuple[Array, Array]:
        """The mean place (3,) and rotation (3, 3) of some samples in the holder."""
        return self._places[rows].mean(axis=0), rotation_near(self._turns[rows].mean(axis=0))

    def score(self, root: Array) -> float:
        """Root mean square, in metres, of the marked vertices' held-out errors."""
        moved = (self._held_out_places - self._places) * self._samples.heights[:, None]
        turned = (self._held_out_turns - self._turns) @ root
        square = np.square(moved).sum(axis=1) + np.square(turned).sum(axis=(1, 2))
        return float(np.sqrt(square.mean()))

    def hold(self, units: int) -> Hold:
        """The mean of all samples, with the calibrated covariance of the held-out errors."""
        turned = rotation_error(self._held_out_turns, self._turns)
        errors = np.concatenate((self._held_out_places - self._places, turned), axis=1)
        covariance = errors.T @ errors / len(errors) + _LEAST_VARIANCE * np.eye(6)
        covariance = widened(covariance, widening_of(units))
        at_each = np.broadcast_to(covariance, (len(errors), 6, 6))
        calibration = calibration_of(at_each, errors, units)
        return Hold(self._holder, *self._mean(np.full(len(errors), True)), calibration * covariance)


_LEAST_VARIANCE = 1e-9
"""Keeps the covariance of an object that never moves in its holder from having no inverse."""
