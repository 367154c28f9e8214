"""Smooths joints that rest, and follows those that move (one-euro filter, Casiez et al. 2012)."""

import numpy as np

from inhand_capture.estimation.found_person import Floats
from inhand_capture.estimation.parameters import DEFAULT_FOLLOWING, FollowingParameters


class OneEuroFilter:
    """Smooths the joints of one person; each by its own speed in space."""

    def __init__(self, joints: int, parameters: FollowingParameters = DEFAULT_FOLLOWING) -> None:
        self._parameters = parameters
        self._places = np.full((joints, 3), np.nan)
        self._velocities = np.zeros((joints, 3))

    def smooth(self, places: Floats, seconds: float) -> Floats:
        """Return the smoothed places (N, 3) that come so many seconds, above 0, after the last.

        A missing joint, NaN, stays so and begins anew when it is seen again.
        """
        parameters = self._parameters
        known = np.isfinite(self._places)
        before = np.where(known, self._places, places)
        velocities = (places - before) / seconds
        velocities = np.where(np.isfinite(velocities), velocities, 0.0)
        self._velocities += _share(parameters.speed_hz, seconds) * (velocities - self._velocities)
        speeds = np.linalg.norm(self._velocities, axis=1, keepdims=True)
        cutoffs = parameters.slowest_hz + parameters.quicker * speeds
        self._places = before + _share(cutoffs, seconds) * (places - before)
        smoothed: Floats = self._places.copy()
        return smoothed


def _share(cutoff: Floats | float, seconds: float) -> Floats | float:
    """Return the share of a new value that a low pass of that frequency, Hz, takes."""
    turned = 2.0 * np.pi * cutoff * seconds
    return turned / (turned + 1.0)
