"""The clock offsets and poses at which two cameras' movements agree best.

For each clock offset the best rigid transform has a closed form (Kabsch 1976; Umeyama 1991) of sums
over all moments and joints, and those sums for all offsets at once are correlations: a few fast
Fourier transforms try every offset. The points are the middles between left and right joints, so
that it does not matter which side a camera takes for which.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft

from inhand_calibration.arrays import Array, Flags, Indices
from inhand_calibration.from_people.estimate import CameraEstimate
from inhand_calibration.from_people.middles import middles
from inhand_calibration.from_people.parameters import SearchParameters
from inhand_calibration.from_people.tracks import Track


@dataclass(frozen=True)
class _Sampled:
    """Middles (T, 10, 3) about their mean at a step of the search, 0 where unknown, and whether
    they are known (T, 10)."""

    start: float
    mean: Array
    points: Array
    known: Array


def hypotheses(
    firsts: Sequence[Track], seconds: Sequence[Track], parameters: SearchParameters
) -> list[CameraEstimate]:
    """Return how the second camera may be placed and timed relative to the first, the best of each
    pair of movements, in no order."""
    pairs = [(first, second) for first in firsts for second in seconds]
    pairs.sort(key=lambda pair: -min(_length(track) for track in pair))
    found: list[CameraEstimate] = []
    for first, second in pairs[: parameters.pairs]:
        found += _best(_sample(first, parameters), _sample(second, parameters), parameters)
    return found


def _length(track: Track) -> float:
    return track.end - track.start


def _sample(track: Track, parameters: SearchParameters) -> _Sampled:
    every = max(round(parameters.step_s / track.step), 1)
    points, known = middles(track.positions[::every], track.support[::every])
    mean = points[known].mean(axis=0) if known.any() else np.zeros(3)
    centred = np.where(known[..., None], points - mean, 0.0)
    return _Sampled(track.start, mean, centred, known.astype(float))


def _best(first: _Sampled, second: _Sampled, parameters: SearchParameters) -> list[CameraEstimate]:
    """The best clock offsets with their poses: second placed in the first's frame."""
    counts, sums, other_sums, squares, cross = _correlations(first, second)
    least = min(parameters.least_overlap_s / parameters.step_s, 0.8 * _shorter(first, second))
    enough = counts >= least * first.known.shape[1] * _share_known(first, second)
    at_least = np.maximum(counts, 1.0)
    scatter = cross - other_sums[:, :, None] * sums[:, None, :] / at_least[:, None, None]
    spread = squares - (np.sum(sums**2, axis=1) + np.sum(other_sums**2, axis=1)) / at_least
    left, values, right = np.linalg.svd(scatter)
    proper = np.linalg.det(left) * np.linalg.det(right) > 0.0
    values[:, 2] *= np.where(proper, 1.0, -1.0)
    errors = np.where(enough, (spread - 2.0 * values.sum(axis=1)) / at_least, np.inf)
    found = []
    for index in _lowest(errors, parameters.hypotheses):
        signs = np.array([1.0, 1.0, 1.0 if proper[index] else -1.0])
        # scatter is Σ second firstᵀ: the rotation takes the second's points to the first's.
        rotation = (right[index].T * signs) @ left[index].T
        own = first.mean + sums[index] / at_least[index]
        other = second.mean + other_sums[index] / at_least[index]
        lag = (index - (len(second.points) - 1)) * parameters.step_s
        offset = first.start + lag - second.start
        found.append(CameraEstimate(rotation, own - rotation @ other, float(offset)))
    return found


def _correlations(first: _Sampled, second: _Sampled) -> tuple[Array, Array, Array, Array, Array]:
    """For every lag L, where the second's start is so many steps after the first's, from minus the
    second's length less 1: number of common points (L,), sums of the first's and of the second's
    (L, 3), sum of both's squares (L,), and Σ second firstᵀ (L, 3, 3)."""
    lags = len(first.points) + len(second.points) - 1
    size = next_fast_len(lags, real=True)
    ones, points = _spectrum(first.known, size), _spectrum(first.points, size)
    squares = _spectrum(np.sum(first.points**2, axis=2), size)
    # The second goes backwards: what is convolution of it is correlation.
    back = slice(None, None, -1)
    other_ones, other_points = (
        _spectrum(second.known[back], size),
        _spectrum(second.points[back], size),
    )
    other_squares = _spectrum(np.sum(second.points[back] ** 2, axis=2), size)

    def at_lags(spectrum: Array) -> Array:
        return np.asarray(irfft(spectrum, size, axis=0)[:lags], float)

    return (
        np.rint(at_lags(np.einsum("fp,fp->f", ones, other_ones))),
        at_lags(np.einsum("fpi,fp->fi", points, other_ones)),
        at_lags(np.einsum("fp,fpi->fi", ones, other_points)),
        at_lags(
            np.einsum("fp,fp->f", squares, other_ones) + np.einsum("fp,fp->f", ones, other_squares)
        ),
        at_lags(np.einsum("fpi,fpj->fij", other_points, points)),
    )


def _spectrum(values: Array, size: int) -> Array:
    return np.asarray(rfft(values, size, axis=0))


def _shorter(first: _Sampled, second: _Sampled) -> int:
    return min(len(first.points), len(second.points))


def _share_known(first: _Sampled, second: _Sampled) -> float:
    return 0.8 * float(first.known.mean() * second.known.mean())


def _lowest(errors: Array, count: int) -> Indices:
    """The lowest local minima of errors (L,), at most so many."""
    around = np.pad(errors, 1, constant_values=np.inf)
    low: Flags = np.isfinite(errors) & (errors <= around[:-2]) & (errors <= around[2:])
    places = np.flatnonzero(low)
    return places[np.argsort(errors[places])[:count]]
