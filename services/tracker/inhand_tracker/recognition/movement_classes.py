"""Judges which action a movement is, and whether it was trained at all.

Mixture discriminant analysis (Hastie and Tibshirani 1996): each action is a few Gaussians with one
covariance for all, shrunk. What a Gaussian says about the action is what it said of people left out
in training, so that poses which all actions share, such as rest, speak for none. One class is that
of people who use nothing. A movement that is farther from every class than people's movements are
speaks for none of the actions, too. Each action is also doubted by itself: a movement has to be as
near to it as the nearer movements of people who do it, above all where no image shows whether there
is an object.

All this holds for bodies like those that were learned. Of others all classes are far, and another
description decides (``arm_courses``).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.recognition.arm_courses import ArmCourses
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION, RecognitionParameters


@dataclass(frozen=True)
class MovementClasses:
    """Classes of movements: K actions and, last, none of them, by G Gaussians.

    ``means`` (D,) and ``whitening`` (D, D) make the covariance of features the identity;
    ``directions`` (D, E) span the Gaussians' ``centres`` (G, E). ``log_shares`` (G,) are the
    logarithms of their weights, ``owners`` (G,) their classes, and ``says`` (G, K + 1) is
    P(class | Gaussian) / P(class). Distances that people keep: ``limits`` (2,) to the nearest
    centre, within the span and outside of it; ``reaches`` (K,) to an action's own nearest centre,
    of a part of its people. ``arms`` are the courses that arms took in the same recordings; None in
    recognisers of older releases.
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
    arms: ArmCourses | None = None

    @property
    def actions(self) -> int:
        """Number of actions, K."""
        return self.says.shape[1] - 1

    def evidence(
        self, features: Array, parameters: RecognitionParameters = DEFAULT_RECOGNITION
    ) -> Array:
        """Log evidence (N, K + 1) of features (N, D), for each action and, last, for none.

        0 speaks neither for nor against.
        """
        shares, distances = self.gaussians(features)
        evidence = np.log(shares @ self.says)
        beyond = self._beyond(distances)
        evidence[:, :-1] -= parameters.strangeness * beyond[:, None]
        evidence[:, -1] += parameters.caution
        return np.asarray(evidence)

    def doubts(
        self,
        features: Array,
        *,
        seeing: bool,
        parameters: RecognitionParameters = DEFAULT_RECOGNITION,
    ) -> Array:
        """Log evidence (N, K + 1) against each action by itself, beside ``evidence``.

        Unless ``seeing`` (an image shows whether an object is there) it is stronger, and some
        speaks for none.
        """
        doubt = parameters.doubt_with_image if seeing else parameters.doubt_without_image
        beyond = np.log(np.maximum(self.apart(features) / self.reaches, 1.0))
        doubts = np.zeros((len(features), self.actions + 1))
        doubts[:, :-1] = -doubt * beyond
        doubts[:, -1] = 0.0 if seeing else parameters.caution_without_image
        return doubts

    def at_home(
        self, features: Array, parameters: RecognitionParameters = DEFAULT_RECOGNITION
    ) -> Array:
        """How far features (N, D) are those of bodies like the learned ones, (N,), 1 to 0."""
        beyond = self._beyond(self.gaussians(features)[1])
        first, last = parameters.home_ends, parameters.far_from_home
        return np.asarray(np.clip((last - beyond) / (last - first), 0.0, 1.0))

    def _beyond(self, distances: Array) -> Array:
        """How many times (log) distances (N, 2) exceed their limits, together, (N,)."""
        return np.asarray(np.log(np.maximum(distances / self.limits, 1.0)).sum(axis=1))

    def apart(self, features: Array) -> Array:
        """Distances (N, K) of features (N, D) from the nearest of each action's own centres."""
        inside, _ = self.project(features)
        squares = np.square(inside[:, None] - self.centres).sum(axis=2)
        nearest = [squares[:, self.owners == action].min(axis=1) for action in range(self.actions)]
        return np.sqrt(np.column_stack(nearest))

    def gaussians(self, features: Array) -> tuple[Array, Array]:
        """Give P(Gaussian | features), (N, G), and the distances (N, 2) that ``limits`` bound."""
        inside, rest = self.project(features)
        squares = np.square(inside[:, None] - self.centres).sum(axis=2)
        logs = self.log_shares - 0.5 * squares
        shares = np.exp(logs - logs.max(axis=1, keepdims=True))
        distances = np.sqrt(np.column_stack((squares.min(axis=1), rest)))
        return shares / shares.sum(axis=1, keepdims=True), distances

    def project(self, features: Array) -> tuple[Array, Array]:
        """Project features (N, D) to the centres' span, (N, E), and give the squared rest (N,)."""
        white = (features - self.means) @ self.whitening
        inside = white @ self.directions
        rest = np.square(white).sum(axis=1) - np.square(inside).sum(axis=1)
        return inside, np.maximum(rest, 0.0)
