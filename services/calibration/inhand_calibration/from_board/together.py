"""Counts in how many places cameras saw the board together, while they look."""

from collections import defaultdict
from itertools import combinations

import numpy as np

from inhand_calibration.arrays import Array

TOGETHER_S = 0.15
"""Time between two sights, at most, that are of one moment."""
ELSEWHERE_PX = 20.0
"""Movement of the board, at least, in one of two pictures, that makes another place."""


class PlacesTogether:
    """Counts places by pairs of cameras; times are of the receiver, whatever the cameras' say."""

    def __init__(self) -> None:
        self._last: dict[str, tuple[float, Array]] = {}
        self._places: dict[tuple[str, str], list[Array]] = defaultdict(list)

    def note(self, camera: str, time_s: float, middle: Array) -> None:
        """Take note of where the middle (2,) of the board was in a picture, pixels."""
        self._last[camera] = (time_s, middle)
        for other, (seen_s, _) in self._last.items():
            if other == camera or time_s - seen_s > TOGETHER_S:
                continue
            pair = (min(camera, other), max(camera, other))
            both = np.concatenate([self._last[name][1] for name in pair])
            places = self._places[pair]
            if all(np.abs(both - place).max() > ELSEWHERE_PX for place in places):
                places.append(both)

    def counts(self, cameras: tuple[str, ...]) -> dict[tuple[str, str], int]:
        """Return in how many places each two cameras saw it."""
        return {pair: len(self._places.get(pair, ())) for pair in combinations(cameras, 2)}
