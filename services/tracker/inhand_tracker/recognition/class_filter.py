"""Filters evidence that comes frame by frame: which action goes on, or none."""

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.weights import normalised_weights
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION, RecognitionParameters

LEAST_PROBABILITY = 1e-300
"""Probability that stands for 0, so that it has a logarithm."""


class ClassFilter:
    """Keeps the probabilities of K actions and, last, of none.

    ``temper`` is the share of each frame's evidence that is new: successive frames say much the
    same.
    """

    def __init__(
        self, actions: int, temper: float, parameters: RecognitionParameters = DEFAULT_RECOGNITION
    ) -> None:
        self._temper = temper
        self._parameters = parameters
        self._changes = _changes(actions, parameters.to_none)
        none = parameters.none_at_first
        self._first = np.append(np.full(actions, (1.0 - none) / actions), none)
        self.restart()

    def restart(self) -> None:
        """Start anew: somebody else comes into view."""
        self._probabilities = self._first.copy()
        self._time_ns: int | None = None

    def step(self, time_ns: int, evidence: Array) -> Array:
        """Give the probabilities (K + 1,) after a frame with log evidence (K + 1,)."""
        frames = self._elapsed_frames(time_ns)
        self._time_ns = time_ns
        stays = self._parameters.stays**frames
        prior = stays * self._probabilities + (1.0 - stays) * self._probabilities @ self._changes
        self._probabilities = reweighted(prior, self._temper * frames * evidence)
        return self._probabilities

    def _elapsed_frames(self, time_ns: int) -> float:
        """Number of frames, at the usual rate, since the last one."""
        rate_hz = self._parameters.rate_hz
        elapsed_s = 1.0 / rate_hz if self._time_ns is None else (time_ns - self._time_ns) / 1e9
        return float(np.clip(elapsed_s, 0.0, self._parameters.longest_step_s)) * rate_hz


def reweighted(probabilities: Array, evidence: Array) -> Array:
    """Weigh probabilities (K,) by log evidence (K,)."""
    return normalised_weights(np.log(np.maximum(probabilities, LEAST_PROBABILITY)) + evidence)


def _changes(actions: int, to_none: float) -> Array:
    """Where a change leads, (K + 1, K + 1): rows sum to 1, the diagonal is 0."""
    table = np.full((actions + 1, actions + 1), 1.0 / actions)
    if actions > 1:
        table[:actions, :actions] = (1.0 - to_none) / (actions - 1)
        table[:actions, actions] = to_none
    np.fill_diagonal(table, 0.0)
    return table
