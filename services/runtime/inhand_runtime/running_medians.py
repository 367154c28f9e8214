"""Medians of several numbers over the last frames, kept up to date frame by frame."""

import numpy as np

from inhand_runtime.kernels.sorted_rows import Counts, Numbers, exchange, medians


class RunningMedians:
    """Keeps the median of each of N numbers over the last frames."""

    def __init__(self, numbers: int, frames: int) -> None:
        self._last = np.full((frames, numbers), np.nan)
        self._ordered = np.empty((numbers, frames))
        self._counts = np.zeros(numbers, np.int64)
        self._frames = 0

    def update(self, numbers: Numbers) -> Numbers:
        """Take one frame's numbers (N,), and give the medians (N,); both may be NaN."""
        row = self._frames % len(self._last)
        exchange(self._ordered, self._counts, self._last[row], numbers)
        self._last[row] = numbers
        self._frames += 1
        typical: Numbers = medians(self._ordered, self._counts)
        return typical

    @property
    def counts(self) -> Counts:
        """How many of the last frames had each number, (N,)."""
        return self._counts
