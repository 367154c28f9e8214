"""Where a movement to and fro turns."""

from dataclasses import dataclass

import numpy as np

from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.track import Track


@dataclass(frozen=True)
class Turns:
    """Indices of the peaks and valleys of a curve, in order, one of the other kind after each.

    ``peaks`` is whether each is a peak. The first is the curve's first extreme that is surely one,
    the last the last that is.
    """

    indices: list[int]
    peaks: list[bool]


def turns_of(values: Array, swing: float) -> Turns:
    """Find where a curve (N,) turns by at least ``swing`` before it turns again."""
    indices: list[int] = []
    peaks: list[bool] = []
    if len(values) == 0:
        return Turns(indices, peaks)
    high = low = 0
    rising: bool | None = None
    for number in range(1, len(values)):
        if values[number] > values[high]:
            high = number
        if values[number] < values[low]:
            low = number
        if rising is not False and values[high] - values[number] >= swing:
            indices.append(high)
            peaks.append(True)
            rising, low = False, number
            high = number
        elif rising is not True and values[number] - values[low] >= swing:
            indices.append(low)
            peaks.append(False)
            rising, high = True, number
            low = number
    return Turns(indices, peaks)


def share_seen(times: Array, seen: Flags, start_s: float, end_s: float) -> float:
    """Share of the frames from ``start_s`` to ``end_s`` that were seen, 0 where there is none."""
    inside = (times >= start_s) & (times <= end_s)
    return float(np.mean(seen[inside])) if inside.any() else 0.0


LIES_S, LIES_M = 1.0, 0.02
"""Time for which a thing is still, and by which it moves at most, once it lies somewhere: in a hand
that pauses it sways more, beside what the tracker errs."""


def end_of_lasting(track: Track, end_s: float, pause_s: float) -> float:
    """Return when an activity ends whose last act ended at ``end_s``: then, or not before the
    track does where another act may follow within ``pause_s`` and the thing does not lie still."""
    last = float(track.times[-1])
    if last - end_s >= pause_s:
        return end_s
    lately = track[track.times >= last - LIES_S]
    lies = (
        last - end_s > LIES_S
        and len(lately) > 3
        and float(np.ptp(lately.positions, axis=0).max()) < LIES_M
    )
    return end_s if lies else last
