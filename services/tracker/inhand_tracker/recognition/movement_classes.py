"""Which action a movement is, and whether it is one that was trained at all.

Mixture discriminant analysis (Hastie and Tibshirani 1996): each action is a few Gaussians with one
covariance for all, shrunk. What a Gaussian says about the action is what it said of people left out
in training, so that poses which all actions share, such as rest, speak for none. One class is that
of people who use nothing. A movement farther from all of them than those of people are speaks for
none of the actions, too. Each action is also doubted by itself: a movement has to be as near to it
as the nearer ones of people are who do it, above all where no image shows whether there is an
object.
"""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array, Indices

CAUTION = 1.0
"""What speaks for none in every frame: a false object is worse than one that is found later."""
STRANGENESS = 8.0
"""How much a movement at e times the limit speaks against every action."""
DOUBT, SEEN_DOUBT = 20.0, 10.0
"""How much a movement at e times an action's reach speaks against that action, without an image,
and with one, which tells more."""
UNSEEN_CAUTION = 2.0
"""What further speaks for none in every frame without an image."""


@dataclass(frozen=True)
class MovementClasses:
    """K actions and, last, none of them, by G Gaussians.

    ``means`` (D,) and ``whitening`` (D, D) make the covariance of features the identity,
    ``directions`` (D, E) span the Gaussians' ``centres`` (G, E), ``log_shares`` (G,) are their
    weights, ``says`` (G, K + 1) is P(class | Gaussian) over P(class); ``limits`` (2,) are the
    distances, to the nearest centre within the span and outside of it, that people keep;
    ``reaches`` (K,) those to an action's own nearest centre that a part of its people keep, and
    ``owners`` (G,) the class of each Gaussian.
    """

    means: Array
    whitening: Array
    directions: Array
    centres: Array
    log_shares: Array
    says: Array
    limits: Array
    reaches: Array
    owners: Indices

    @property
    def actions(self) -> int:
        """K."""
        return self.says.shape[1] - 1

    def evidence(self, features: Array) -> Array:
        """Log evidence (N, K + 1) of features (N, D), for each action and, last, for none.

        0 is what speaks neither for nor against.
        """
        shares, distances = self.gaussians(features)
        evidence = np.log(shares @ self.says)
        beyond = np.log(np.maximum(distances / self.limits, 1.0)).sum(axis=1)
        evidence[:, :-1] -= STRANGENESS * beyond[:, None]
        evidence[:, -1] += CAUTION
        return np.asarray(evidence)

    def doubts(self, features: Array, *, seeing: bool) -> Array:
        """Log evidence (N, K + 1) against each action by itself, and, without an image that tells
        whether an object is there, for none."""
        doubts = np.zeros((len(features), self.actions + 1))
        beyond = np.log(np.maximum(self.apart(features) / self.reaches, 1.0))
        doubts[:, :-1] = -(SEEN_DOUBT if seeing else DOUBT) * beyond
        doubts[:, -1] = 0.0 if seeing else UNSEEN_CAUTION
        return doubts

    def apart(self, features: Array) -> Array:
        """How far features (N, D) are from the nearest centre of each action's own, (N, K)."""
        inside, _ = self.project(features)
        squares = np.square(inside[:, None] - self.centres).sum(axis=2)
        nearest = [squares[:, self.owners == action].min(axis=1) for action in range(self.actions)]
        return np.sqrt(np.column_stack(nearest))

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
