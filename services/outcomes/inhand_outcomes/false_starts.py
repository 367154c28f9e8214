"""Moments in which a tracker thought that a thing was elsewhere: they are no evidence.

A thing that is at once far from where it was, faster than any hand moves it, and soon after at once
where it was before, was there all the time.
"""

from dataclasses import dataclass, replace

import numpy as np

from inhand_outcomes.arrays import Array
from inhand_outcomes.track import Track


@dataclass(frozen=True)
class FalseStartParameters:
    """What a false start is."""

    jump_m: float = 0.15
    """Least way of a jump, metres."""
    jump_m_s: float = 9.0
    """Least speed of a jump, m/s: grips of rackets and clubs, the fastest things, reach 6 to 8."""
    jump_s: float = 0.3
    """Time between two poses at most by which a jump is told, seconds: later a hand can have moved
    it there."""
    longest_s: float = 2.5
    """Seconds after which a thing that did not come back was truly moved: until then nobody
    knows."""
    back_m: float = 0.15
    """Distance from where it was before within which it has come back, metres: two errors of a
    tracker."""


DEFAULT_FALSE_STARTS = FalseStartParameters()


def without_false_starts(
    track: Track, parameters: FalseStartParameters = DEFAULT_FALSE_STARTS
) -> Track:
    """The track with false starts, and what may still turn out to be one, as not seen."""
    shown = np.flatnonzero(track.seen)
    if len(shown) < 2:
        return track
    times, places = track.times[shown], track.positions[shown]
    ways, seconds = np.linalg.norm(np.diff(places, axis=0), axis=1), np.diff(times)
    jumps = (ways > parameters.jump_m) & (seconds <= parameters.jump_s)
    jumps &= ways > parameters.jump_m_s * seconds
    starts: list[int] = (np.flatnonzero(jumps) + 1).tolist()
    if not starts:
        return track
    seen = track.seen.copy()
    until = -1
    for number, start in enumerate(starts):
        if start < until:
            continue
        ends = [end for end in starts[number + 1 :] if _is_soon(times, start, end, parameters)]
        back = next((end for end in ends if _is_back(places, start, end, parameters)), None)
        if back is not None:
            seen[shown[start:back]] = False
            until = back + 1
        elif times[-1] - times[start] < parameters.longest_s:
            seen[shown[start:]] = False
            break
    return replace(track, seen=seen)


def _is_soon(times: Array, start: int, end: int, parameters: FalseStartParameters) -> bool:
    return bool(times[end] - times[start] <= parameters.longest_s)


def _is_back(places: Array, start: int, end: int, parameters: FalseStartParameters) -> bool:
    return bool(np.linalg.norm(places[end] - places[start - 1]) <= parameters.back_m)
