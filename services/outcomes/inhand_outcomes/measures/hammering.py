"""Hammering: each strike of the face, at which speed, and how many a minute.

A strike is a movement of the face ahead that grows faster until it ends at once, and goes back:
what stops it is what it hits. A hammer that is waved slows down before it turns.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inhand_outcomes.achievement import Achievement, Amount
from inhand_outcomes.arrays import Array
from inhand_outcomes.measures.smoothing import smooth
from inhand_outcomes.measures.turning import share_seen, turns_of
from inhand_outcomes.normal import normal_share
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track

FACE_AHEAD = np.array([0.0, 1.0, 0.0])
"""Where the face of a hammer looks, in its frame."""


@dataclass(frozen=True)
class HammeringParameters:
    """What a strike is."""

    half_width_s: float = 0.06
    """Time on either side over which the face's place is smoothed: a third of the fastest fall."""
    step_s: float = 1.0 / 60.0
    """Time between the places that are looked at."""
    swing_m: float = 0.06
    """Way of the face ahead, and back, at least: light taps go twice as far."""
    back_m: float = 0.045
    """Way back after a strike from which it is surely over."""
    longest_s: float = 0.9
    """Time of a fall, at most."""
    last_share: float = 0.34
    """Share of a fall's way in the last third of its time from which it ends at once: 0.44 where it
    grows faster evenly, 0.25 where it slows down as movements do that end by themselves; both
    between a twentieth and 0.95 of the way, smoothed."""
    last_share_short: float = 0.23
    """The same of a fall that takes half of ``long_s``: smoothing takes more of its end."""
    long_s: float = 0.30
    """Time of a fall from which smoothing changes it little."""
    last_deviation: float = 0.10
    """Deviation of that share by noise, of one fall."""
    burst_s: float = 1.5
    """Time between the strikes of one burst, at most: the rate is that within bursts."""
    least_speed_m_s: float = 0.35
    """Speed of the face below which a movement is not looked at."""
    strike_m_s: float = 0.95
    """Speed of the face from which a movement ahead of ``strike_m`` is a strike: a hammer that
    falls from 5 cm has 1 m/s; one that is put to a nail, or hovers between strikes, has 0.5 to
    0.8 m/s. Shorter ones must be as much faster."""
    strike_m: float = 0.14
    """Way of the face of such a movement."""
    strike_deviation: float = 0.10
    """Deviation of the logarithm of speed times way by which strikes are told."""
    seen: float = 0.6
    """Share of a strike's frames that must be seen, about."""


DEFAULT_HAMMERING = HammeringParameters()


@dataclass(frozen=True)
class _Fall:
    start_s: float
    end_s: float
    over_s: float
    way_m: float
    back_m: float
    peak_m_s: float
    speed_m_s: float
    speed_error_m_s: float
    last: float
    error_m: float
    seen: float


def hammering(
    track: Track, thing: Thing, parameters: HammeringParameters = DEFAULT_HAMMERING
) -> list[Achievement]:
    """Find strikes; each has its speed, and its rate where it is one of a burst."""
    if len(track) < 8:
        return []
    falls = _falls(track, thing, parameters)
    chances = [_chance(falls, fall, parameters) for fall in falls]
    surely = [fall.end_s for fall, chance in zip(falls, chances, strict=True) if chance > 0.5]
    found = []
    for fall, chance in zip(falls, chances, strict=True):
        amounts = {"speed_m_s": Amount(fall.speed_m_s, fall.speed_error_m_s)}
        rate = _rate(np.array(surely), fall.end_s, parameters)
        if rate is not None:
            amounts["rate_per_min"] = rate
        evidence = {
            "way_m": fall.way_m,
            "peak_m_s": fall.peak_m_s,
            "last": fall.last,
            "seen": fall.seen,
        }
        found.append(Achievement("strike", fall.start_s, fall.end_s, chance, amounts, evidence))
    return found


def _chance(falls: Sequence[_Fall], fall: _Fall, parameters: HammeringParameters) -> float:
    """How surely a fall is a strike: far, fast, turned back, ended at once as others are, seen."""
    burst = [one.last for one in falls if abs(one.end_s - fall.end_s) <= parameters.burst_s]
    last, noise = float(np.median(burst)), parameters.last_deviation / np.sqrt(min(len(burst), 4))
    error = max(fall.error_m, 1e-4)
    long = np.clip(2.0 * (fall.end_s - fall.start_s) / parameters.long_s - 1.0, 0.0, 1.0)
    least = parameters.last_share_short
    least += long * (parameters.last_share - least)
    hard = np.log(fall.peak_m_s * fall.way_m / (parameters.strike_m_s * parameters.strike_m))
    scores = (
        (fall.way_m - 0.8 * parameters.swing_m) / error,
        (fall.back_m - 0.7 * parameters.back_m) / error,
        hard / parameters.strike_deviation,
        (last - least) / noise,
        (fall.seen - parameters.seen) / 0.12,
    )
    return float(np.prod(normal_share(np.array(scores))))


def _falls(track: Track, thing: Thing, parameters: HammeringParameters) -> list[_Fall]:
    """Movements of the face ahead that are turned back."""
    face = thing.part("face", "+y")
    at = np.arange(track.times[0], track.times[-1], parameters.step_s)
    both = np.column_stack([track.points(face), track.directions(FACE_AHEAD)])
    smoothed = smooth(track.times, both, track.seen, at, parameters.half_width_s)
    ahead = smoothed.values[:, 3:] / np.linalg.norm(smoothed.values[:, 3:], axis=1, keepdims=True)
    speeds = np.nan_to_num(np.sum(smoothed.slopes[:, :3] * ahead, axis=1))
    gone = np.cumsum(speeds) * parameters.step_s
    errors = np.interp(at, track.times, track.point_deviations(face))
    turns = turns_of(gone, parameters.back_m)
    found = []
    bounds = [*turns.indices, len(at) - 1]
    for number in range(1, len(turns.indices)):
        if not turns.peaks[number]:
            continue
        before, peak, after = bounds[number - 1 : number + 2]
        fall = _fall(at, gone, speeds, (before, peak, after), errors, parameters)
        seen = share_seen(track.times, track.seen, fall.start_s, fall.over_s)
        if (
            fall.way_m >= parameters.swing_m
            and fall.peak_m_s >= parameters.least_speed_m_s
            and fall.end_s - fall.start_s <= parameters.longest_s
        ):
            found.append(_Fall(**{**vars(fall), "seen": seen}))
    return found


def _fall(
    at: Array,
    gone: Array,
    speeds: Array,
    turns: tuple[int, int, int],
    errors: Array,
    parameters: HammeringParameters,
) -> _Fall:
    """What a fall between three turns is: from the last rest before the peak, to the way back."""
    before, peak, after = turns
    way = float(gone[peak] - gone[before])
    # A hammer that hovered before it fell: the fall begins with a twentieth of its way.
    start = before + int(np.flatnonzero(gone[before : peak + 1] - gone[before] <= 0.05 * way)[-1])
    end = before + int(np.flatnonzero(gone[before : peak + 1] - gone[before] >= 0.95 * way)[0])
    third = round(end - (end - start) / 3.0)
    third_s = max((end - third) * parameters.step_s, parameters.step_s)
    # What grows evenly faster is a fifth faster at its end than on average in its last third, of
    # which smoothing takes a tenth.
    speed = 1.33 * float(gone[end] - gone[third]) / third_s
    error = 0.7 * float(errors[before : after + 1].mean())
    back = gone[peak] - gone[peak : after + 1]
    over = peak + int(np.flatnonzero(back >= 0.8 * parameters.back_m)[0])
    return _Fall(
        start_s=float(at[start]),
        end_s=float(at[end]),
        over_s=float(at[over]),
        way_m=way,
        back_m=float(back.max()),
        peak_m_s=float(speeds[start : peak + 1].max()),
        speed_m_s=speed,
        # Errors are alike in the short time, but for a third; and a third begins within a frame.
        speed_error_m_s=float(np.hypot(0.33 * error / third_s, 0.12 * speed)),
        last=float((gone[end] - gone[third]) / max(gone[end] - gone[start], 1e-9)),
        # The errors of both ends of a way, of which most is alike.
        error_m=error,
        seen=1.0,
    )


def _rate(ends: Array, end_s: float, parameters: HammeringParameters) -> Amount | None:
    """Strikes a minute among the neighbours of a strike; None for one alone."""
    near = ends[np.abs(ends - end_s) <= parameters.burst_s]
    intervals = np.diff(near)
    if len(intervals) == 0 or end_s not in near:
        return None
    rate = 60.0 / float(np.median(intervals))
    spread = float(np.std(60.0 / intervals)) / np.sqrt(len(intervals))
    # A strike is timed to a frame, about.
    return Amount(rate, float(np.hypot(spread, rate**2 / 60.0 * 0.03)))
