"""Smooth curves through what was seen, at any frame rate and with frames missing."""

from dataclasses import dataclass

import numpy as np

from inhand_outcomes.arrays import Array, Flags


@dataclass(frozen=True)
class Smoothed:
    """Values (A, K) and their slopes (A, K), a second, at A times; NaN where too little was seen.

    ``support`` (A,) is how many frames each rests on; what errs alike for ``errors_last_s`` counts
    once in ``averaged`` (A,).
    """

    values: Array
    slopes: Array
    support: Array
    averaged: Array


ERRORS_LAST_S = 0.3
"""Time for which a tracker's errors are alike, about, as seen of tracked recordings."""


def smooth(
    times: Array,
    values: Array,
    seen: Flags,
    at: Array,
    half_width_s: float,
    order: int = 1,
    spans_s: Array | None = None,
) -> Smoothed:
    """Fit lines (``order`` 1) or parabolas (2) to values (T, K) around each of ``at`` (A,).

    Frames within ``half_width_s`` count, those nearer more (Epanechnikov's kernel). Too little is
    fewer than ``order`` + 1 frames, or frames on one side alone. Values that are means over spans
    of ``spans_s`` (T,) about their times are fitted by means of the parabola over them.
    """
    spans = np.zeros(len(times)) if spans_s is None else spans_s
    times, values, spans = times[seen], values[seen], spans[seen]
    missing = np.full((len(at), values.shape[1]), np.nan)
    if len(times) == 0:
        return Smoothed(missing, missing, np.zeros(len(at)), np.zeros(len(at)))
    first = np.searchsorted(times, at - half_width_s)
    counts = np.searchsorted(times, at + half_width_s) - first
    most = max(int(counts.max()), 1)
    rows = first[:, None] + np.arange(most)
    inside = np.arange(most) < counts[:, None]
    rows = np.minimum(rows, len(times) - 1)
    away = (times[rows] - at[:, None]) / half_width_s
    weights = np.where(inside, 1.0 - away**2, 0.0)
    powers = away[..., None] ** np.arange(order + 1)
    if order == 2:
        powers[..., 2] += (spans[rows] / half_width_s) ** 2 / 12.0
    weighted = powers * weights[..., None]
    normal = np.einsum("ati,atj->aij", weighted, powers)
    right = np.einsum("ati,atk->aik", weighted, values[rows])
    spread = np.where(inside, away, 0.0)
    both_sides = (spread.min(axis=1) <= 0.05) & (spread.max(axis=1) >= -0.05)
    span = np.where(counts > 0, times[np.clip(first + counts - 1, 0, len(times) - 1)], 0.0)
    span = span - times[np.minimum(first, len(times) - 1)]
    enough = (counts > order) & both_sides & (span > 0.5 * half_width_s)
    normal[~enough] = np.eye(order + 1)
    fitted = np.linalg.solve(normal + 1e-9 * np.eye(order + 1), right)
    fitted[~enough] = np.nan
    # A third of the kernel's width errs alike with the rest, whatever the frame rate.
    alike = np.full(len(at), max(1.2 * half_width_s / ERRORS_LAST_S, 1.0))
    return Smoothed(
        fitted[:, 0], fitted[:, 1] / half_width_s, weights.sum(axis=1), np.minimum(alike, counts)
    )
