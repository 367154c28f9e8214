"""Lifting weights: each repetition, its range, how long it went up and down, and how level.

A repetition is the bar going up and down again in the room and as seen from the shoulders: who
stoops for a bar, or rises with it, lifts it in one of the two alone.
"""

from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import Joint

from inhand_outcomes.achievement import Achievement, Amount
from inhand_outcomes.arrays import Array
from inhand_outcomes.hands import hand_distances
from inhand_outcomes.measures.smoothing import smooth
from inhand_outcomes.measures.turning import share_seen, turns_of
from inhand_outcomes.normal import normal_share
from inhand_outcomes.thing import Thing, end_of
from inhand_outcomes.track import Track


@dataclass(frozen=True)
class LiftingParameters:
    """What a repetition is."""

    half_width_s: float = 0.18
    """Time on either side over which heights are smoothed: a third of a quick lift."""
    step_s: float = 0.04
    """Time between the heights that are looked at."""
    range_m: float = 0.18
    """Height by which the bar goes up, and down again, at least: half of a curl of short arms."""
    slow: float = 0.15
    """Share of its highest speed below which a movement begins or ends."""
    whole: float = 0.79
    """Share of a movement's time in which it is faster: that of movements of least jerk (Flash and
    Hogan, 1985)."""
    widened_s: float = 0.04
    """Time by which smoothing begins a movement too early, and ends it too late."""
    longest_s: float = 12.0
    """Time of a repetition, at most: what is held up longer is stored, or hangs."""
    smoothing_m: float = 0.005
    """Deviation of a range by smoothing, which cuts tops and bottoms."""
    shoulders_m: float = 0.02
    """Deviation of the height of the shoulders in skeletons."""
    level: float = np.radians(25.0)
    """Tilt of the bar, radians, up to which two hands lift it."""
    level_deviation: float = np.radians(5.0)
    """Standard deviation of that tilt, beside that of the pose: bars sway."""
    long_m: float = 0.6
    """Length from which it takes two hands: dumbbells have up to 0.45 m."""
    both_m: float = 0.3
    """Distance of the farther hand from a long bar within which it holds it, metres."""
    both_deviation_m: float = 0.04
    """Standard deviation of that distance."""
    seen: float = 0.5
    """Share of a repetition's frames that must be seen, about."""


DEFAULT_LIFTING = LiftingParameters()


@dataclass(frozen=True)
class _Lift:
    """A way up and down: indices of where it begins, of its top and of where it ends."""

    begin: int
    top: int
    end: int


def lifting(
    track: Track, thing: Thing, parameters: LiftingParameters = DEFAULT_LIFTING
) -> list[Achievement]:
    """Find repetitions; ``tilt_deg`` is above 0 where the right end is the higher one."""
    if len(track) < 8:
        return []
    at = np.arange(track.times[0], track.times[-1], parameters.step_s)
    heights = _smoothed(track, track.positions[:, 2:], at, parameters)[:, 0]
    from_shoulders = _from_shoulders(track, heights, at, parameters)
    tilts, ends_apart_m = _tilts(track, thing, at, parameters)
    errors = np.interp(at, track.times, np.sqrt(track.covariances[:, 2, 2]))
    turning = np.interp(at, track.times, track.turn_deviations())
    found = []
    for lift in _lifts(from_shoulders, parameters):
        rows = slice(lift.begin, lift.end + 1)
        ranges = [
            min(series[lift.top] - series[lift.begin], series[lift.top] - series[lift.end])
            for series in (heights, from_shoulders)
        ]
        begun, topped, lowered, ended = _phases(from_shoulders, at, lift, parameters)
        if ended - begun > parameters.longest_s or not np.isfinite(ranges).all():
            continue
        error = float(np.hypot(1.4 * errors[rows].mean(), parameters.smoothing_m))
        by_shoulders = float(np.hypot(error, parameters.shoulders_m))
        seen = share_seen(track.times, track.seen, begun, ended)
        scores = [
            (ranges[0] - parameters.range_m) / error,
            (ranges[1] - parameters.range_m) / by_shoulders,
            (seen - parameters.seen) / 0.12,
        ]
        tilt, turned = float(np.nanmean(tilts[rows])), float(turning[rows].mean())
        turned = float(np.hypot(turned / np.sqrt(max((ended - begun) / 0.3, 1.0)), 0.005))
        if ends_apart_m > parameters.long_m:
            level = (parameters.level - abs(tilt)) / np.hypot(parameters.level_deviation, turned)
            farther = _farther_hand(track, thing, begun, ended)
            both = (parameters.both_m - farther) / parameters.both_deviation_m
            scores += [level, both]
        up_s, down_s = topped - begun, ended - lowered
        found.append(
            Achievement(
                "repetition",
                begun,
                ended,
                float(np.prod(normal_share(np.array(scores)))),
                {
                    "range_m": Amount(float(ranges[0]), error),
                    "up_s": Amount(up_s, 0.1 + 0.05 * up_s),
                    "down_s": Amount(down_s, 0.1 + 0.05 * down_s),
                    "duration_s": Amount(ended - begun, 0.15),
                    "tilt_deg": Amount(float(np.degrees(tilt)), float(np.degrees(turned))),
                    "difference_m": Amount(
                        ends_apart_m * float(np.sin(tilt)), ends_apart_m * turned
                    ),
                },
                {"from_shoulders_m": float(ranges[1]), "seen": seen},
            )
        )
    return found


def _farther_hand(track: Track, thing: Thing, begun: float, ended: float) -> float:
    """How far, metres, the farther hand usually is from the bar; 0 where both are never known."""
    frames = track.seen & (track.times >= begun) & (track.times <= ended)
    distances = hand_distances(track[frames], thing).max(axis=1)
    known = distances[np.isfinite(distances)]
    return float(np.median(known)) if len(known) else 0.0


def _smoothed(track: Track, values: Array, at: Array, parameters: LiftingParameters) -> Array:
    return smooth(track.times, values, track.seen, at, parameters.half_width_s).values


def _from_shoulders(
    track: Track, heights: Array, at: Array, parameters: LiftingParameters
) -> Array:
    """Height (A,) of the bar above the shoulders, or in the room where they are not known."""
    shoulders = track.joint(Joint.SHOULDER_CENTER)[:, 2:]
    known = np.isfinite(shoulders[:, 0])
    if known.mean() < 0.5:
        return heights
    smoothed = smooth(track.times, shoulders, known, at, parameters.half_width_s).values[:, 0]
    there = np.isfinite(smoothed)
    return heights - np.interp(at, at[there], smoothed[there])


def _tilts(
    track: Track, thing: Thing, at: Array, parameters: LiftingParameters
) -> tuple[Array, float]:
    """How far (A,) the bar is tilted, radians, the right end up, and how long it is, metres."""
    ends = np.array([end_of(thing.vertices, way) for way in ("+x", "-x")])
    bar = track.points(ends)
    axis = bar[:, 0] - bar[:, 1]
    across = track.joint(Joint.SHOULDER_RIGHT) - track.joint(Joint.SHOULDER_LEFT)
    # A bar can be turned round unseen: which end is the right one is asked of the shoulders.
    side = np.sign(np.nansum(np.where(np.isfinite(across), across, 0.0) * axis, axis=1))
    axis *= np.where(side == 0.0, 1.0, side)[:, None]
    smoothed = _smoothed(track, axis, at, parameters)
    length = np.linalg.norm(smoothed, axis=1)
    return np.arcsin(np.clip(smoothed[:, 2] / np.maximum(length, 1e-9), -1.0, 1.0)), float(
        np.linalg.norm(ends[0] - ends[1])
    )


def _lifts(heights: Array, parameters: LiftingParameters) -> list[_Lift]:
    """The ways up and down again of a height (A,), NaN where it was not seen."""
    there = np.flatnonzero(np.isfinite(heights))
    turns = turns_of(heights[there], 0.8 * parameters.range_m)
    bounds = [0, *turns.indices, len(there) - 1]
    lifts = []
    for number, peak in enumerate(turns.peaks):
        if not peak:
            continue
        before, top, after = (there[bounds[number + shift]] for shift in range(3))
        low = heights[top : after + 1]
        lifts.append(_Lift(int(before), int(top), int(top + np.nanargmin(low))))
    return lifts


def _phases(
    heights: Array, at: Array, lift: _Lift, parameters: LiftingParameters
) -> tuple[float, float, float, float]:
    """When a repetition begins, is at its top, leaves it and ends, seconds."""
    speeds = np.gradient(heights, at)
    up = _movement(speeds, at, (lift.begin, lift.top), parameters)
    down = _movement(-speeds, at, (lift.top, lift.end), parameters)
    return max(up[0], float(at[0])), up[1], down[0], down[1]


def _movement(
    speeds: Array, at: Array, between: tuple[int, int], parameters: LiftingParameters
) -> tuple[float, float]:
    """When the movement begins and ends that is fastest between two indices.

    Its slow ends are hidden in noise: what is between is drawn out to them.
    """
    first, last = between
    part = np.nan_to_num(speeds[first : last + 1])
    fastest = int(np.argmax(part))
    slow = part < parameters.slow * part[fastest]
    before, after = np.flatnonzero(slow[:fastest]), np.flatnonzero(slow[fastest:])
    begins = first + (int(before[-1]) if len(before) else 0)
    ends = min(first + fastest + int(after[0]), last) if len(after) else last
    drawn = 0.5 * (1.0 / parameters.whole - 1.0) * (at[ends] - at[begins]) - parameters.widened_s
    return float(at[begins] - drawn), float(at[ends] + drawn)
