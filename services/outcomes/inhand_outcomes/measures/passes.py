"""The single movements of something that goes to and fro: from one turn or halt to the next."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from inhand_outcomes.arrays import Array


@dataclass(frozen=True)
class Halting:
    """Where a movement ends and another begins without a turn."""

    share: float = 0.42
    """Share of the speeds before and after down to which it falls: the speed of one movement rises
    once and falls once."""
    moves_m_s: float = 0.25
    """Speed above which something surely moves."""


DEFAULT_HALTING = Halting()


def ways_of(
    at: Array, places: Array, retreat_m: float, halting: Halting = DEFAULT_HALTING
) -> list[int]:
    """Return indices of the ends of movements among places (N, K) at times (N,): the first, those
    where a way turns back by ``retreat_m`` or halts, and the last."""
    turns = _turns(places, retreat_m)
    if len(places) < 3:
        return turns
    speeds = np.linalg.norm(np.gradient(places, at, axis=0), axis=1)
    ends = [turns[0]]
    for begin, end in pairwise(turns):
        ends += [*_halts(speeds, begin, end, halting), end]
    return ends


def moving_part(gone: Array) -> slice:
    """Return the part of a movement, whose share gone is (N,), without its slow ends."""
    begun = np.flatnonzero(gone < 0.04)
    ended = np.flatnonzero(gone > 0.96)
    first = int(begun[-1]) if len(begun) else 0
    last = int(ended[0]) if len(ended) else len(gone) - 1
    return slice(first, last + 1) if last > first else slice(0, len(gone))


def _turns(places: Array, retreat: float) -> list[int]:
    """Indices of the first place (N, K), of those where a way turns back, and of the last."""
    if len(places) == 0:
        return [0]
    turns, start, furthest = [0], 0, 0
    for number in range(1, len(places)):
        reached = np.linalg.norm(places[furthest] - places[start])
        if np.linalg.norm(places[number] - places[start]) >= reached:
            furthest = number
        elif np.linalg.norm(places[number] - places[furthest]) > retreat:
            turns.append(furthest)
            start = furthest
            furthest = number
    return [*turns, furthest] if furthest != turns[-1] else turns


def _halts(speeds: Array, begin: int, end: int, halting: Halting) -> Sequence[int]:
    """Indices between two, in order, at which something of these speeds (N,) halts."""
    part = speeds[begin : end + 1]
    rising = np.maximum.accumulate(part)
    falling = np.maximum.accumulate(part[::-1])[::-1]
    peaks = np.minimum(rising, falling)
    slow = np.where(peaks > halting.moves_m_s, part / np.maximum(peaks, 1e-9), 1.0)
    halt = begin + int(np.argmin(slow))
    if slow[halt - begin] >= halting.share:
        return []
    before = _halts(speeds, begin, halt, halting)
    return [*before, halt, *_halts(speeds, halt, end, halting)]
