"""Where a thing stays that a hand has let go of, whatever a tracker makes of it then.

A small thing that returns no depth is tracked by the hand that holds it: it is seen well until the
hand leaves, and then its pose leaps, though nobody touches it. What rested in a hand, and is in
none afterwards, lies where it rested.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.hands import HANDS, hand_distances
from inhand_outcomes.stillness import runs_of, still_frames
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track


@dataclass(frozen=True)
class LeftBehindParameters:
    """When a thing was let go of."""

    rest_s: float = 0.4
    """Seconds for which it must have rested in a hand: fingers open slowly."""
    wander_m: float = 0.04
    """Distance by which it may wander meanwhile, metres: the wander of a tracked pose."""
    least_seen: float = 0.7
    """Share of the frames in which it must be seen, while it rests and afterwards."""
    near_m: float = 0.13
    """Distance of a hand's joint from its surface up to which a hand may hold it, metres."""
    far_m: float = 0.20
    """Distance of a hand from where it rested beyond which it has let go of it, metres."""
    left_m: float = 0.13
    """The same for a hand that is not near, of the hand from where it was then, metres."""
    leap_m: float = 0.20
    """Distance from where it rested beyond which nothing can be without a hand, metres: a pose in a
    hand is off by less."""
    still_s: float = 0.7
    """Seconds for which both hands must be away, and for which a pose must stay where it is to be
    believed again, nearer than that."""
    deviation_m: float = 0.015
    """Standard deviation, along an axis, of where it lies against where it rested in the hand,
    metres: in 14 tracked recordings it was 1.4 cm, errors of tracking among it."""


DEFAULT_LEFT_BEHIND = LeftBehindParameters()


def left_behind(
    track: Track,
    thing: Thing,
    worn: Flags,
    trusted: Flags,
    parameters: LeftBehindParameters = DEFAULT_LEFT_BEHIND,
) -> tuple[Track, Flags]:
    """The track with a thing that was let go of where it rested in the hand before, and the frames
    (T,) in which it lies there.

    Only ``trusted`` (T,) poses rest in a hand. It lies until a hand comes to it, or to where it is
    tracked, or until it is ``worn`` (T,) no farther away. Where it is seen at rest nearby, both
    count, by their covariances.
    """
    hands = hand_distances(track, thing)
    with np.errstate(invalid="ignore"):
        held = track.seen & (hands < parameters.near_m).any(axis=1)
    rests = held & trusted & ~worn & _still(track, parameters.rest_s, parameters)
    poses, covariances = track.poses.copy(), track.covariances.copy()
    lies = np.zeros(len(track), bool)
    runs = runs_of(rests)
    for number, run in enumerate(runs):
        until = runs[number + 1].start if number + 1 < len(runs) else len(track)
        first, beyond, last = run.start, run.stop, run.stop - 1
        there, covariance = _rested(track, first, last, parameters)
        near = np.linalg.norm(track.positions - there[:3], axis=1) < parameters.leap_m
        # A pose may follow the hand that leaves for a moment; what was taken along goes on.
        ends = np.flatnonzero(np.where(near, worn, held)[beyond:])
        since = slice(last, min(beyond + int(ends[0]), until) if len(ends) else until)
        if held[since].all():
            continue
        for span in _let_go(track, thing, there, held, since, parameters):
            frames = np.arange(len(track))[span]
            lies[frames] = True
            believed = frames[near[frames] & _believed(track[span], parameters)]
            rest = np.setdiff1d(frames, believed)
            poses[rest], covariances[rest] = there, covariance
            for frame in believed:
                own = covariances[frame, :3, :3]
                share = np.trace(covariance[:3, :3]) / np.trace(covariance[:3, :3] + own)
                poses[frame, :3] += (1.0 - share) * (there[:3] - poses[frame, :3])
    return replace(track, poses=poses, covariances=covariances), lies


def _still(track: Track, seconds: float, parameters: LeftBehindParameters) -> Flags:
    return still_frames(track, seconds, parameters.wander_m, parameters.least_seen)


def _rested(
    track: Track, first: int, last: int, parameters: LeftBehindParameters
) -> tuple[Array, Array]:
    """The most usual pose (7,) of a thing that rested in these frames and just before, and its
    covariance (6, 6)."""
    first = int(np.searchsorted(track.times, track.times[first] - parameters.rest_s + 1e-6))
    frames = np.arange(first, last + 1)
    frames = frames[track.seen[frames]]
    place = np.median(track.positions[frames], axis=0)
    usual = frames[np.linalg.norm(track.positions[frames] - place, axis=1).argmin()]
    covariance = track.covariances[usual].copy()
    covariance[:3, :3] += parameters.deviation_m**2 * np.eye(3)
    return np.concatenate([place, track.poses[usual, 3:]]), covariance


def _let_go(
    track: Track,
    thing: Thing,
    there: Array,
    held: Flags,
    since: slice,
    parameters: LeftBehindParameters,
) -> Iterator[slice]:
    """The frames since a rest in which both hands are away, if that lasts, until one is back."""
    resting = replace(track[since], poses=np.tile(there, (len(track[since]), 1)))
    hands = hand_distances(resting, thing)
    joints = resting.joints[:, HANDS]
    moved = np.linalg.norm(joints - joints[0], axis=2)
    with np.errstate(invalid="ignore"):
        near = hands < parameters.near_m
        left = ~near & (moved > parameters.left_m)
        away = np.asarray(((hands > parameters.far_m) | left).all(axis=1)) & ~held[since]
    if not away.any():
        return
    first = int(np.argmax(away))
    back = np.flatnonzero(near[first:].any(axis=1) | held[since][first:])
    span = slice(first, first + int(back[0]) if len(back) else len(away))
    times = resting.times[span]
    seen = resting.seen[span].mean()
    if times[-1] - times[0] >= parameters.still_s and seen >= parameters.least_seen:
        yield slice(since.start + span.start, since.start + span.stop)


def _believed(after: Track, parameters: LeftBehindParameters) -> Flags:
    """Frames (S,) of a time in which a thing stays where it is."""
    believed = np.zeros(len(after), bool)
    for frame in np.flatnonzero(_still(after, parameters.still_s, parameters)):
        first = int(np.searchsorted(after.times, after.times[frame] - parameters.still_s + 1e-6))
        believed[first : frame + 1] = True
    return believed
