"""How performances of one thing differ: repetitions, places of things, interruptions.

Where no source is named, a number is assumed; `inhand simulate --sheet FILE` shows what they make,
and tests/lab/motions/test_motions.py holds that bodies and things keep their laws.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PerformanceParameters:
    """What differs from performance to performance, also of one person.

    Pairs are without variety, as up to world version 6, and with all of it.
    """

    jitter: float = 0.10
    """Deviation of the logarithm of a movement's duration between repetitions."""
    shortest_pause: float = 0.4
    """Duration of the shortest pause, as a share of the usual one."""
    place_factor: tuple[float, float] = (1.0, 1.4)
    """Factor on the spread of where furniture and things stand."""
    height_factor: tuple[float, float] = (1.0, 1.4)
    """Factor on the spread of the heights of tables."""
    interruptions: float = 1.0
    """Mean number of times that somebody stops in a movement in a performance; none at variety
    0."""
    undone: float = 0.4
    """Share of these in which what was begun is then undone and begun again."""
    interrupted_after_s: tuple[float, float] = (0.25, 0.6)
    """Time after which a movement is interrupted, at least and at the most, seconds."""
    stop_s: tuple[float, float] = (0.2, 1.2)
    """Time for which somebody stops, at least and at the most, seconds."""
    slowing_s: float = 0.25
    """Time that stopping and going on again take each, seconds."""

    def places(self, variety: float) -> float:
        """Factor on the spread of places at a share of variety."""
        return _between(self.place_factor, variety)

    def heights(self, variety: float) -> float:
        """Factor on the spread of tables' heights at a share of variety."""
        return _between(self.height_factor, variety)


def _between(pair: tuple[float, float], share: float) -> float:
    without, all_of_it = pair
    return without + share * (all_of_it - without)


DEFAULT_PERFORMANCE = PerformanceParameters()
"""How all simulated performances differ."""
