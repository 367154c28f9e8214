"""A support vector machine with class probabilities, as LIBSVM computes them, in NumPy.

One machine for every pair of classes; each decision value becomes a probability by a sigmoid
(Platt 2000), and the pairs are coupled (Wu, Lin and Weng 2004, their second method). Training is
the lab's.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from inhand_tracker.geometry.arrays import Array

# LIBSVM's numbers (svm.cpp), which this file agrees with.
LEAST_PAIR_PROBABILITY = 1e-7
"""Probability that neither class of a pair falls below."""
COUPLING_ROUNDS = 100
"""Number of rounds of coupling at the most."""
COUPLING_TOLERANCE = 0.005
"""Change, times the number of classes, below which coupling ends."""


@dataclass(frozen=True)
class PairwiseSvm:
    """A machine for each of the K (K - 1) / 2 pairs i < j of K classes.

    Pairs come in the order (0, 1), (0, 2), …, (1, 2), … ``vectors`` (V, D) are the support vectors
    of all machines, ``coefficients`` (V, pairs) and ``offsets`` (pairs,) theirs, ``gamma`` that of
    the kernel exp(−γ |x − v|²), ``sigmoids`` (pairs, 2): P(i | i or j) = 1 / (1 + exp(A f + B)).
    """

    vectors: Array
    coefficients: Array
    offsets: Array
    gamma: float
    sigmoids: Array

    @property
    def classes(self) -> int:
        """Number of classes, K."""
        return int((1 + np.sqrt(1 + 8 * len(self.offsets))) / 2)

    @cached_property
    def _squares(self) -> Array:
        return np.square(self.vectors).sum(axis=1)

    def decisions(self, points: Array) -> Array:
        """Decide on points (N, D), (N, pairs): a positive value speaks for a pair's first class."""
        squares = np.square(points).sum(axis=1)[:, None] + self._squares
        distances = np.maximum(squares - 2.0 * points @ self.vectors.T, 0.0)
        return np.exp(-self.gamma * distances) @ self.coefficients + self.offsets

    def probabilities(self, points: Array) -> Array:
        """Probabilities (N, K) of the classes of points (N, D)."""
        slopes, shifts = self.sigmoids.T
        exponents = np.clip(slopes * self.decisions(points) + shifts, -500.0, 500.0)
        wins = np.clip(
            1.0 / (1.0 + np.exp(exponents)), LEAST_PAIR_PROBABILITY, 1.0 - LEAST_PAIR_PROBABILITY
        )
        first, second = np.triu_indices(self.classes, 1)
        pairwise = np.zeros((len(points), self.classes, self.classes))
        pairwise[:, first, second] = wins
        pairwise[:, second, first] = 1.0 - wins
        return couple(pairwise)


def couple(pairwise: Array) -> Array:
    """Combine r_ij = P(i | i or j), (N, K, K) with a zero diagonal, to class probabilities (N, K).

    Minimises Σ (r_ji p_i − r_ij p_j)² under Σ p = 1 (Wu, Lin and Weng 2004, algorithm 2).
    """
    count = pairwise.shape[-1]
    flipped = np.swapaxes(pairwise, -1, -2)
    quadratic = -flipped * pairwise
    diagonal = np.arange(count)
    quadratic[:, diagonal, diagonal] = np.square(flipped).sum(axis=2)
    shares = np.full(pairwise.shape[:2], 1.0 / count)
    for _ in range(COUPLING_ROUNDS):
        pushed = np.einsum("nij,nj->ni", quadratic, shares)
        level = np.einsum("ni,ni->n", shares, pushed)
        if np.abs(pushed - level[:, None]).max() < COUPLING_TOLERANCE / count:
            break
        for t in range(count):
            step = (level - pushed[:, t]) / quadratic[:, t, t]
            shares[:, t] += step
            level = (level + step * (step * quadratic[:, t, t] + 2.0 * pushed[:, t])) / (
                1.0 + step
            ) ** 2
            pushed = (pushed + step[:, None] * quadratic[:, t]) / (1.0 + step)[:, None]
            shares /= (1.0 + step)[:, None]
    return shares
