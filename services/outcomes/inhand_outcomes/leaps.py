"""Leaps of a thing that lies: where no hand came to it, it lies there still.

A tracker that follows what one person uses is drawn to their hands: a phone on a table is thought
to be at the ear of somebody who scratches it there. But nothing leaves its place by itself.
"""

from dataclasses import dataclass, replace

import numpy as np

from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.hands import hand_distances
from inhand_outcomes.stillness import frames_apart, still_frames
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track


@dataclass(frozen=True)
class LeapParameters:
    """When a thing lies, and what takes it away."""

    step_s: float = 0.1
    """Seconds between the frames that are looked at."""
    still_s: float = 0.7
    """Seconds for which a thing must have stayed where it is, both hands away, to lie there."""
    wander_m: float = 0.05
    """Distance by which it may wander meanwhile, metres: that of a tracked pose."""
    least_seen: float = 0.7
    """Share of that time in which it must be seen."""
    reach_m: float = 0.16
    """Distance of a hand's joint from the surface of a thing where it lies from which on the hand
    may take it, metres: what is taken is measured at 2 to 12 cm, and what lies is tracked 3 cm
    off."""
    there_m: float = 0.05
    """Distance from where it lies within which it is there, metres."""
    before_s: float = 0.2
    """Seconds before it was there last in which such a hand counts as well: trackers tell late."""
    leap_m: float = 0.25
    """Distance from where it lies by which it has left, metres: several errors of a tracker."""
    back_m: float = 0.15
    """Distance within which it is there again, metres."""


DEFAULT_LEAPS = LeapParameters()


def without_leaps(track: Track, thing: Thing, parameters: LeapParameters = DEFAULT_LEAPS) -> Track:
    """The track with what it says of a thing that leapt from where it lies as not seen.

    That ends when the thing is there again, when a hand comes to where it lies, and when it lies
    elsewhere: then it was never where it seemed to lie. Where no hand is known nothing is a leap.
    """
    looked = frames_apart(track.times, parameters.step_s)
    false = _leaps(track[looked], thing, parameters)
    if not false.any():
        return track
    return replace(track, seen=track.seen & ~false[np.cumsum(looked) - 1])


def _leaps(track: Track, thing: Thing, parameters: LeapParameters) -> Flags:
    """Frames (T,) in which the thing only seems to have left where it lies."""
    false = np.zeros(len(track), bool)
    still = still_frames(track, parameters.still_s, parameters.wander_m, parameters.least_seen)
    if not still.any():
        return false
    away = _hands_away(track, thing, parameters)
    lies = still & away & ~_any_within(~away, track.times, parameters.still_s)
    place: Array | None = None
    there = 0
    near = np.zeros(len(track), bool)
    for frame in range(len(track)):
        if lies[frame]:
            if place is None or _off(track, frame, place) > parameters.back_m:
                near = _hands_at(track, thing, track.poses[frame], parameters)
            place, there = track.positions[frame], frame
        elif place is not None and track.seen[frame]:
            off = _off(track, frame, place)
            if off < parameters.there_m:
                there = frame
            elif off > parameters.leap_m:
                false[frame] = not near[there : frame + 1].any()
                if not false[frame]:
                    place = None
    return false


def _off(track: Track, frame: int, place: Array) -> float:
    return float(np.linalg.norm(track.positions[frame] - place))


def _hands_at(track: Track, thing: Thing, pose: Array, parameters: LeapParameters) -> Flags:
    """Frames (T,) in which a hand is, or was just now, at a thing in this pose (7,), or nobody
    knows where hands are."""
    away = _hands_away(replace(track, poses=np.tile(pose, (len(track), 1))), thing, parameters)
    return _any_within(~away, track.times, parameters.before_s)


def _hands_away(track: Track, thing: Thing, parameters: LeapParameters) -> Flags:
    """Frames (T,) in which both hands are known to be away from the thing."""
    with np.errstate(invalid="ignore"):
        away = hand_distances(track, thing) > parameters.reach_m
    return np.asarray(away.all(axis=1))


def _any_within(flags: Flags, times: Array, seconds: float) -> Flags:
    """Frames (T,) in which, or in the seconds before which, any flag (T,) is set."""
    counted = np.concatenate([[0], np.cumsum(flags)])
    firsts = np.searchsorted(times, times - seconds - 1e-6)
    return np.asarray(counted[1:] - counted[firsts] > 0)
