"""Which action a movement is, and whether it is one that was trained at all.

Mixture discriminant analysis (Hastie and Tibshirani 1996): each action is a few Gaussians with one
covariance for all, shrunk. What a Gaussian says about the action is what it said of people left out
in training, so that poses which all actions share, such as rest, speak for none. A movement far
from all of them speaks for none of the actions (a logistic model of two distances).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MovementClasses:
    """K actions by G Gaussians.

    ``means`` (D,) and ``whitening`` (D, D) make the covariance of features the identity,
    ``directions`` (D, E) span the Gaussians' ``centres`` (G, E), ``log_shares`` (G,) are their
    weights, ``says`` (G, K) is P(action | Gaussian); ``strangeness`` (3,) are the coefficients of
    the log odds that a movement was not trained: constant, log distance to the nearest centre
    within the span, log distance outside of it.
    """

    means: Array
    whitening: Array
    directions: Array
    centres: Array
    log_shares: Array
    says: Array
    strangeness: Array

    def evidence(self, features: Array) -> Array:
        """Log evidence (N, K + 1) of features (N, D), for each action and, last, for none.

        0 is what speaks neither for nor against.
        """
        shares, distances = self.gaussians(features)
        actions = np.log(shares @ self.says * self.says.shape[1])
        odds = strangeness_inputs(distances) @ self.strangeness
        known, strange = -np.logaddexp(0.0, odds), -np.logaddexp(0.0, -odds)
        return np.column_stack((actions + known[:, None], strange)) + np.log(2.0)

    def gaussians(self, features: Array) -> tuple[Array, Array]:
        """P(Gaussian | features), (N, G), and the two distances (N, 2)."""
        inside, rest = self.project(features)
        squares = np.square(inside[:, None] - self.centres).sum(axis=2)
        logs = self.log_shares - 0.5 * squares
        shares = np.exp(logs - logs.max(axis=1, keepdims=True))
        distances = np.sqrt(np.column_stack((squares.min(axis=1), rest)))
        return shares / shares.sum(axis=1, keepdims=True), distances

    def project(self, features: Array) -> tuple[Array, Array]:
        """Features (N, D) in the span of the centres, (N, E), and the squared rest (N,)."""
        white = (features - self.means) @ self.whitening
        inside = white @ self.directions
        rest = np.square(white).sum(axis=1) - np.square(inside).sum(axis=1)
        return inside, np.maximum(rest, 0.0)


def strangeness_inputs(distances: Array) -> Array:
    """What the logistic model reads, (N, 3), of two distances (N, 2)."""
    return np.column_stack((np.ones(len(distances)), np.log(np.maximum(distances, 1e-6))))
