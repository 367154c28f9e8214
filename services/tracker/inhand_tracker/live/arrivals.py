"""Measures a camera's period by when its messages arrive."""

from collections import deque

from inhand_tracker.live.parameters import DEFAULT_MOMENTS, MomentsParameters

SHORTEST_PERIOD_S = 1e-3
"""Period in seconds below which none is taken to be: no camera is as fast."""


class Arrivals:
    """The last arrivals of one stream, in seconds of a clock that nobody sets."""

    def __init__(self, parameters: MomentsParameters = DEFAULT_MOMENTS) -> None:
        self._parameters = parameters
        self._times: deque[float] = deque(maxlen=parameters.intervals + 1)

    def add(self, arrived: float) -> None:
        """Take an arrival; after a pause the camera may be another one."""
        if self._times and arrived - self._times[-1] > self._parameters.longest_interval_s:
            self._times.clear()
        self._times.append(arrived)

    @property
    def period_s(self) -> float:
        """Mean of the last intervals, in seconds."""
        intervals = len(self._times) - 1
        if intervals < self._parameters.fewest_intervals:
            return self._parameters.first_period_s
        return max((self._times[-1] - self._times[0]) / intervals, SHORTEST_PERIOD_S)
