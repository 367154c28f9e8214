"""Which frame of a recording is to be shown now."""

import numpy as np
from inhand_tracker.geometry.arrays import Indices

RATES = ("0.1", "0.25", "0.5", "1", "2", "4", "8")
"""Times as fast as it was recorded."""


class Player:
    """Plays frames that were taken at ``times_ns`` (T,), as time goes on, in seconds."""

    def __init__(self, times_ns: Indices) -> None:
        # Where a clock was set back, time stands still until it has caught up.
        self._seconds = np.maximum.accumulate(times_ns - times_ns[0]) / 1e9
        self._frame = 0
        self._began: float | None = None
        self._rate = 1.0

    @property
    def playing(self) -> bool:
        """Whether it goes on by itself."""
        return self._began is not None

    def frame(self, now: float) -> int:
        """Return the frame of a time; at the last one it stops."""
        if self._began is None:
            return self._frame
        at = self._seconds[self._frame] + (now - self._began) * self._rate
        frame = max(int(np.searchsorted(self._seconds, at, side="right")) - 1, self._frame)
        if frame >= len(self._seconds) - 1:
            self.jump(len(self._seconds) - 1)
            return self._frame
        return frame

    def play(self, rate: float, now: float) -> None:
        """Go on from where it is, so many times as fast as it was recorded; at the end, anew."""
        frame = self.frame(now)
        self._frame = 0 if frame == len(self._seconds) - 1 else frame
        self._rate, self._began = rate, now

    def stop(self, now: float) -> None:
        """Stay where it is."""
        self._frame, self._began = self.frame(now), None

    def jump(self, frame: int) -> None:
        """Stay at a frame, or at the first or last one where it is beyond."""
        self._frame, self._began = min(max(frame, 0), len(self._seconds) - 1), None
