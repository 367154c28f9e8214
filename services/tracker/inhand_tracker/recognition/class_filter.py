"""Which action goes on, or none, from evidence that comes frame by frame: a forward filter."""

import numpy as np

from inhand_tracker.geometry.arrays import Array

RATE_HZ = 30.0
STAYS = 0.997
"""The chance that an action, or none, goes on in the next thirtieth of a second (Darby et al. 2012,
section 5: a change as rare as a pose 3 σ away)."""
NONE_AT_FIRST = 0.9
TO_NONE = 0.5
"""Of the changes from an action, the share that leads to none."""
LONGEST_STEP_S = 1.0


class ClassFilter:
    """Probabilities of K actions and, last, of none.

    ``temper`` is how much of each frame's evidence is new: successive frames tell much the same.
    """

    def __init__(self, actions: int, temper: float) -> None:
        self._temper = temper
        self._changes = _changes(actions)
        self._first = np.append(np.full(actions, (1.0 - NONE_AT_FIRST) / actions), NONE_AT_FIRST)
        self.restart()

    def restart(self) -> None:
        """Somebody else comes into view."""
        self._probabilities = self._first.copy()
        self._time_ns: int | None = None

    def step(self, time_ns: int, evidence: Array) -> Array:
        """The probabilities (K + 1,) after a frame with log evidence (K + 1,)."""
        since = 1.0 / RATE_HZ if self._time_ns is None else (time_ns - self._time_ns) / 1e9
        frames = float(np.clip(since, 0.0, LONGEST_STEP_S)) * RATE_HZ
        self._time_ns = time_ns
        stays = STAYS**frames
        prior = stays * self._probabilities + (1.0 - stays) * self._probabilities @ self._changes
        logs = np.log(np.maximum(prior, 1e-300)) + self._temper * frames * evidence
        weights = np.exp(logs - logs.max())
        self._probabilities = weights / weights.sum()
        return self._probabilities


def _changes(actions: int) -> Array:
    """Where a change leads, (K + 1, K + 1): rows sum to 1, the diagonal is 0."""
    table = np.full((actions + 1, actions + 1), 1.0 / actions)
    if actions > 1:
        table[:actions, :actions] = (1.0 - TO_NONE) / (actions - 1)
        table[:actions, actions] = TO_NONE
    np.fill_diagonal(table, 0.0)
    return table
