"""Swinging: strokes with a racket and swings of a golf club, with speed and plane of the head.

Between two frames a club turns by a radian or more, so speeds are those of a body that turns evenly
from one pose to the next, not of the straight way between. They are means over that time, which is
allowed for where they are smoothed. What is slower than the least speed of its kind, a waggle or
the way back to the address, is none.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inhand_outcomes.achievement import Achievement, Amount
from inhand_outcomes.arrays import Array
from inhand_outcomes.measures.smoothing import smooth
from inhand_outcomes.measures.turning import share_seen
from inhand_outcomes.normal import normal_share
from inhand_outcomes.rotations import (
    conjugate,
    multiply,
    rotation_vectors,
)
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track


@dataclass(frozen=True)
class SwingingParameters:
    """What a stroke is."""

    kind: str
    least_m_s: float
    """Speed of the head from which it is one."""
    log_deviation: float = 0.12
    """Deviation of the logarithm of that speed: people and clubs differ."""
    shortest_pair_s: float = 0.015
    """Time between the two poses of a speed, at least: what they err is divided by it."""
    longest_pair_s: float = 0.075
    """The same at most: in a longer time anything may have happened."""
    half_width_s: float = 0.06
    """Time on either side over which speeds are smoothed: a quarter of a downswing."""
    step_s: float = 1.0 / 120.0
    """Time between the speeds that are looked at."""
    apart_s: float = 0.6
    """Time between two strokes, at least."""
    near_s: float = 1.0
    near_share: float = 0.6
    """What is slower than this share of a stroke so near to it is how the arm got there: a ball
    does not come back within a second."""
    back_s: float = 2.0
    back_share: float = 0.3
    """The same of what follows a stroke: the way back from where it ended."""
    ended: float = 0.45
    """Share of the highest speed below which a stroke begins and ends."""
    plane: float = 0.45
    """Share of it above which the head's way is in the plane of the stroke."""
    smoothing: float = 0.07
    """Share of a speed by which it errs however good the poses are: a club that hits a ball loses a
    third of its speed within 10 ms, so that at 30 frames a second the highest is read 6 % too slow,
    give or take 4 %, beside its markers at 240; where nothing is hit it is within 3 %."""
    seen: float = 0.5
    """Share of a stroke's frames that must be seen, about."""


TENNIS = SwingingParameters(kind="stroke", least_m_s=4.5)
"""Soft strokes of beginners have 6 m/s; the ready position is taken with less than 3 m/s."""
GOLF = SwingingParameters(kind="swing", least_m_s=16.0)
"""Full swings have 25 m/s and more, irons of good players 38 m/s; waggles have up to 7 m/s, and a
club that is brought back from the finish up to 13 m/s. Putts and chips are slower, and none."""


def tennis(
    track: Track, thing: Thing, parameters: SwingingParameters = TENNIS
) -> list[Achievement]:
    """Find strokes with a racket."""
    return _strokes(track, thing, parameters)


def golf(track: Track, thing: Thing, parameters: SwingingParameters = GOLF) -> list[Achievement]:
    """Find swings of a golf club."""
    return _strokes(track, thing, parameters)


def head_of(thing: Thing) -> Array:
    """Return the middle (3,) of the head: its part ``head``, or where the thing is widest.

    Things lie along z; of two ends as wide it is the one farther from the origin, where hands are.
    """
    if "head" in thing.parts:
        return thing.parts["head"]
    z = thing.vertices[:, 2]
    bins = np.linspace(z.min(), z.max(), 16)
    which = np.clip(np.digitize(z, bins) - 1, 0, 14)
    widths = np.zeros(15)
    for number in range(15):
        part = thing.vertices[which == number]
        if len(part) > 1:
            widths[number] = float(np.linalg.norm(np.ptp(part[:, :2], axis=0)))
    wide = np.flatnonzero(widths >= 0.8 * widths.max())
    middles = 0.5 * (bins[wide] + bins[wide + 1])
    farthest = middles[np.argmax(np.abs(middles))]
    near = wide[np.abs(middles - farthest) < 0.25 * np.ptp(z)]
    head = thing.vertices[np.isin(which, near)]
    return 0.5 * (head.min(axis=0) + head.max(axis=0))


def _strokes(track: Track, thing: Thing, parameters: SwingingParameters) -> list[Achievement]:
    head = head_of(thing)
    if track.seen.sum() < 6:
        return []
    middles, speeds, errors, spans = head_speeds(track, head, parameters)
    if len(middles) < 4:
        return []
    at = np.arange(middles[0], middles[-1], parameters.step_s)
    flags = np.ones(len(middles), bool)
    half = max(parameters.half_width_s, 1.6 * float(np.median(np.diff(middles))))
    smoothed = smooth(middles, speeds[:, None], flags, at, half, order=2, spans_s=spans)
    known = np.isfinite(smoothed.values[:, 0])
    curve = np.where(known, smoothed.values[:, 0], 0.0)
    found = []
    peaks = _peaks(at, curve, parameters)
    for peak in _without_ways_back(at, curve, peaks, parameters):
        slow = known & (curve < parameters.ended * curve[peak])
        before, after = np.flatnonzero(slow[:peak]), np.flatnonzero(slow[peak:])
        if len(before) == 0 or len(after) == 0:
            continue
        start, end = float(at[before[-1]]), float(at[peak + after[0]])
        error = float(np.interp(at[peak], middles, errors)) / np.sqrt(
            max(float(smoothed.support[peak]), 1.0)
        )
        speed = float(curve[peak])
        deviation = float(np.hypot(error, parameters.smoothing * speed))
        spread = np.hypot(parameters.log_deviation, deviation / speed)
        seen = share_seen(track.times, track.seen, start, end)
        scores = (
            np.log(speed / parameters.least_m_s) / spread,
            (seen - parameters.seen) / 0.12,
        )
        amounts = {"speed_m_s": Amount(speed, deviation)}
        plane = _plane(track, head, at[curve > parameters.plane * speed], (start, end))
        if plane is not None:
            amounts["angle_deg"] = plane
        chance = float(np.prod(normal_share(np.array(scores))))
        evidence = {"peak_s": float(at[peak]), "seen": seen}
        found.append(Achievement(parameters.kind, start, end, chance, amounts, evidence))
    return found


def head_speeds(
    track: Track, head: Array, parameters: SwingingParameters
) -> tuple[Array, Array, Array, Array]:
    """Return the head's mean speeds (N,) from one seen pose to another, the middles of these times
    (N,), the speeds' deviations (N,) and the seconds between (N,)."""
    seen = track[track.seen]
    times = seen.times
    later = np.searchsorted(times, times + parameters.shortest_pair_s)
    first = np.flatnonzero(later < len(times))
    second = later[first]
    seconds = times[second] - times[first]
    near = seconds <= parameters.longest_pair_s
    first, second, seconds = first[near], second[near], seconds[near]
    rotations = seen.poses[:, 3:]
    turns = rotation_vectors(multiply(rotations[second], conjugate(rotations[first])))
    angles = np.linalg.norm(turns, axis=1)
    axes = turns / np.maximum(angles, 1e-12)[:, None]
    points = seen.points(head)
    moved = points[second] - points[first]
    along = np.sum(moved * axes, axis=1)
    # What turns evenly goes along a screw: an arc is longer than its chord.
    arcs = np.linalg.norm(moved - along[:, None] * axes, axis=1) / np.sinc(0.5 * angles / np.pi)
    speeds = np.hypot(along, arcs) / seconds
    deviations = seen.point_deviations(head)
    # Errors of neighbouring frames are much alike.
    apart = 0.5 * np.hypot(deviations[first], deviations[second])
    return 0.5 * (times[first] + times[second]), speeds, apart / seconds, seconds


def _peaks(at: Array, curve: Array, parameters: SwingingParameters) -> list[int]:
    """Indices at which a speed (A,) is the highest for a while, and worth a look."""
    reach = round(parameters.apart_s / parameters.step_s)
    fast = np.flatnonzero(curve > 0.6 * parameters.least_m_s)
    return [
        int(number)
        for number in fast
        if number > 0
        and curve[number] >= curve[max(number - reach, 0) : number + reach + 1].max()
        and curve[number] > curve[number - 1]
    ]


def _without_ways_back(
    at: Array, curve: Array, peaks: Sequence[int], parameters: SwingingParameters
) -> list[int]:
    """The peaks of speed that are no way of another: to where its stroke begins, or back."""
    kept = []
    for peak in peaks:
        since = at[peak] - at[list(peaks)]
        shares = curve[peak] / curve[list(peaks)]
        near = (np.abs(since) <= parameters.near_s) & (shares < parameters.near_share)
        back = (since > 0.0) & (since <= parameters.back_s) & (shares < parameters.back_share)
        if not (near | back).any():
            kept.append(peak)
    return kept


def _plane(track: Track, head: Array, fast: Array, between: tuple[float, float]) -> Amount | None:
    """Angle between the floor and the plane of the head's way while it is fast, degrees."""
    if len(fast) == 0:
        return None
    margin = 0.02
    inside = track.seen & (track.times >= max(fast[0], between[0]) - margin)
    inside &= track.times <= min(fast[-1], between[1]) + margin
    if inside.sum() < 4:
        return None
    way = track.points(head)[inside]
    _, sizes, axes = np.linalg.svd(way - way.mean(axis=0), full_matrices=False)
    if sizes[1] < 1e-6:
        return None
    angle = float(np.degrees(np.arccos(np.clip(abs(axes[2, 2]), 0.0, 1.0))))
    error = float(np.hypot(track.point_deviations(head)[inside].mean(), 0.01))
    # What is off the plane, or errs, turns it about its long axis: over the lesser extent.
    bent = float(np.hypot(sizes[2], error * np.sqrt(2.0)))
    return Amount(angle, float(np.degrees(np.arctan2(bent, sizes[1]))) + 1.0)
