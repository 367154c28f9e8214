"""What happens to any thing: taken up, put down, dropped, gone with who holds it."""

from dataclasses import dataclass, replace
from itertools import groupby, pairwise

import numpy as np
from inhand_schemas.joints import Joint
from numpy.lib.stride_tricks import sliding_window_view

from inhand_outcomes.achievement import Achievement, Amount
from inhand_outcomes.arrays import Array, Flags, Indices
from inhand_outcomes.false_starts import without_false_starts
from inhand_outcomes.hands import HANDS, hand_distances
from inhand_outcomes.left_behind import left_behind
from inhand_outcomes.normal import normal_share
from inhand_outcomes.stillness import frames_apart, runs_of
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track

TAKEN_UP, PUT_DOWN, DROPPED, LEFT_IN_USE = "taken_up", "put_down", "dropped", "left_in_use"
PLACE = {"place_x_m", "place_y_m", "place_z_m"}
"""Amounts of what was put down or dropped: where it lies in the room."""
UNKNOWN, HELD, LYING = 0, 1, 2


@dataclass(frozen=True)
class HandlingParameters:
    """When a thing is in somebody's hands, and when it lies."""

    step_s: float = 0.1
    """Seconds between the frames that are looked at: nobody takes a thing up faster."""
    near_m: float = 0.13
    """Distance of a hand's joint from a thing's surface up to which it may hold it, metres: half a
    hand, and the error of both."""
    far_m: float = 0.20
    """Distance from which on no hand holds it, metres."""
    away_m: float = 0.25
    """Distance that both hands must reach while a thing lies, metres: a held one may be measured
    as beyond ``far_m`` for moments."""
    passed_m: float = 0.13
    """Change of a hand's distance while the thing stays where it is, by which that hand does not
    hold it, metres: over ``steady_s`` the distance of a held one errs by 3 cm."""
    steady_s: float = 0.3
    """Seconds over which the median of a hand's distance is taken."""
    reach_m: float = 0.22
    """Distance from a thing where it lies to which a hand must have come to take it up or to put it
    there, metres."""
    reach_deviation_m: float = 0.03
    """Standard deviation of that distance."""
    reached_s: float = 2.0
    """Seconds before it lies, or from when it was last seen to lie, within which the hand must have
    come: a tracker may tell late."""
    noise: float = 3.0
    """Deviations of a pose that are taken from a way, squared, along each axis: the farthest of
    many poses is so far off by error alone."""
    on_head_m: float = 0.22
    """Distance from the head's joint up to which a thing is worn, not put down, metres."""
    on_foot_m: float = 0.13
    """The same from an ankle's or a foot's joint."""
    still_s: float = 0.7
    """Seconds for which a thing must stay where it is to lie there."""
    still_m: float = 0.04
    """Distance by which it may wander meanwhile, metres: the wander of a tracked pose."""
    least_seen: float = 0.7
    """Share of the frames of that time in which it, and both hands, must be seen."""
    moved_m: float = 0.06
    """Distance from where it lay by which a thing was moved, metres."""
    moved_s: float = 0.4
    """Seconds for which it must be held as far away: nobody uses a thing for less, and poses err
    for moments."""
    sure: float = 0.95
    """Probability that it was moved from which on nobody waits for more of it."""
    waits_s: float = 3.0
    """Seconds from when a hand is at it, after which as much is known of that as there will be:
    who takes a thing up slowly has moved it by then."""
    doubt: float = 2.0
    """Factor of the deviation along the one axis that is known worst: along the sight of a camera
    what returns no depth is known by the hand that holds it, and what lies is drawn towards hands:
    a flute on a table by 21 cm, where its deviation was said to be 3.5 to 5."""
    hidden_s: float = 5.0
    """Seconds without sight of it between a hand and a place after which what is seen there is as
    likely as not another thing, or taken for one."""
    fallen_m: float = 0.35
    """Distance between a hand and the place where a thing came to lie, and height by which it fell,
    beyond which nobody put it there, metres."""
    longest_fall_s: float = 1.5
    """Seconds between a hand and the floor at the most."""


DEFAULT_HANDLING = HandlingParameters()


@dataclass(frozen=True)
class Stretch:
    """Frames ``first`` to ``last`` of a track in which a thing is held, or lies."""

    state: int
    first: int
    last: int


def handling(
    track: Track,
    thing: Thing,
    *,
    ended: bool = False,
    parameters: HandlingParameters = DEFAULT_HANDLING,
) -> list[Achievement]:
    """Find where a thing was taken up, put down or dropped, in order of time.

    The track is as the tracker says it, with false starts: what leaps away from where a hand has
    left it is none.

    At the end of a track that ``ended`` in somebody's hands, it was left in use: they went out of
    view with it.
    """
    steps = frames_apart(track.times, parameters.step_s)
    looked = track[steps]
    if not looked.seen.any():
        return []
    trusted = without_false_starts(track).seen[steps]
    looked, lies = left_behind(looked, thing, _worn(looked, parameters), trusted)
    looked = replace(looked, seen=lies | trusted)
    states = np.where(lies, LYING, _states(looked, thing, parameters))
    stretches = _used(looked, _stretches(states), parameters)
    achievements = []
    for before, after in pairwise(stretches):
        if (before.state, after.state) == (LYING, HELD):
            goes_on = not ended and after is stretches[-1]
            achievements += _taken_up(looked, thing, before, after, parameters, goes_on=goes_on)
        elif (before.state, after.state) == (HELD, LYING):
            achievements += _put_down(looked, thing, before, after, parameters)
    if ended and stretches and stretches[-1].state == HELD:
        achievements.append(_left(looked, stretches[-1], parameters))
    return achievements


def _states(track: Track, thing: Thing, parameters: HandlingParameters) -> Array:
    """What happens to the thing (T,): UNKNOWN, HELD or LYING."""
    hands = hand_distances(track, thing)
    if np.isnan(track.joints).all():  # nobody is there who could hold it
        hands = np.full_like(hands, np.inf)
    states = np.full(len(track), UNKNOWN)
    with np.errstate(invalid="ignore"):
        states[track.seen & (hands < parameters.near_m).any(axis=1)] = HELD
        for stay in _stays(track, parameters):
            known = hands[stay][~np.isnan(hands[stay]).any(axis=1)]
            if len(known) < parameters.least_seen * len(hands[stay]):
                continue
            frames = max(round(parameters.steady_s / parameters.step_s), 1)
            steady = sliding_window_view(known, min(frames, len(known)), axis=0)
            steady = np.median(steady, axis=-1)
            nearest, farthest = steady.min(axis=0), steady.max(axis=0)
            free = (nearest > parameters.far_m) & (farthest > parameters.away_m)
            free |= farthest - nearest > parameters.passed_m
            if free.all():
                lying = track.seen[stay] & (hands[stay] > parameters.near_m).all(axis=1)
                states[stay][lying] = LYING
    states[_worn(track, parameters)] = UNKNOWN
    return states


def _worn(track: Track, parameters: HandlingParameters) -> Flags:
    """Frames (T,) in which the thing is on a head or a foot."""
    feet = (Joint.ANKLE_LEFT, Joint.FOOT_LEFT, Joint.ANKLE_RIGHT, Joint.FOOT_RIGHT)
    to_head = np.linalg.norm(track.positions - track.joint(Joint.HEAD), axis=1)
    to_feet = np.linalg.norm(track.positions[:, None] - track.joints[:, feet], axis=2)
    worn = (to_head < parameters.on_head_m) | (to_feet < parameters.on_foot_m).any(axis=1)
    return np.asarray(worn)


def _stays(track: Track, parameters: HandlingParameters) -> list[slice]:
    """Stretches of ``still_s`` or longer in which the thing stays where it is."""
    still = np.zeros(len(track), bool)
    ends = np.searchsorted(track.times, track.times + parameters.still_s)
    for first, end in enumerate(ends):
        there = slice(first, end + 1)
        seen = track.seen[there]
        places = track.positions[there][seen]
        if end >= len(track) or seen.mean() < parameters.least_seen:
            continue
        wander = np.linalg.norm(places - np.median(places, axis=0), axis=1)
        if wander.max() < parameters.still_m:
            still[there] = True
    return runs_of(still)


def _used(track: Track, stretches: list[Stretch], parameters: HandlingParameters) -> list[Stretch]:
    """The stretches without those in which a thing that lies was touched, and not moved."""
    used: list[Stretch] = []
    for number, stretch in enumerate(stretches):
        lay = bool(used) and used[-1].state == LYING
        if stretch.state == HELD and lay and number + 1 < len(stretches):
            moved, _ = _moved(track, used[-1], stretch, parameters)
            if moved < parameters.moved_m:
                continue
        if stretch.state == LYING and lay:
            stretch = Stretch(LYING, used.pop().first, stretch.last)
        used.append(stretch)
    return used


def _stretches(states: Array) -> list[Stretch]:
    """Stretches of one state, over what is unknown between them."""
    known = [(int(state), index) for index, state in enumerate(states) if state != UNKNOWN]
    groups = (
        (state, [index for _, index in group])
        for state, group in groupby(known, key=lambda one: one[0])
    )
    return [Stretch(state, indices[0], indices[-1]) for state, indices in groups]


def _place(track: Track, stretch: Stretch) -> tuple[Array, Array]:
    """Where a thing lies (3,): the median, and its covariance (3, 3)."""
    frames = _shown(track, stretch)
    # Errors of neighbouring frames are alike: many frames are no better than a typical one.
    return (
        np.median(track.positions[frames], axis=0),
        np.median(track.covariances[frames, :3, :3], axis=0),
    )


def _moved(
    track: Track, lying: Stretch, held: Stretch, parameters: HandlingParameters
) -> tuple[float, float]:
    """How far from where it lay a thing was held for ``moved_s`` at the least, metres, beyond what
    may be error, and the probability that it was moved."""
    place, covariance = _place(track, lying)
    frames = _shown(track, held)
    ways = track.positions[frames] - place
    variances, axes = np.linalg.eigh(covariance + track.covariances[frames, :3, :3])
    # The last axis is the one that is known worst, and widened as far as it is known worse.
    variances[:, 2] += (parameters.doubt**2 - 1.0) * (variances[:, 2] - variances[:, 1])
    along = np.einsum("tji,tj->ti", axes, ways)
    beyond = np.maximum(np.square(along) - parameters.noise**2 * variances, 0.0)
    distances = np.sqrt(beyond.sum(axis=1))
    times = track.times[frames]
    firsts = np.searchsorted(times, times - parameters.moved_s + parameters.step_s / 2.0)
    whole = times - times[0] >= parameters.moved_s - parameters.step_s / 2.0
    lasting = np.array(
        [distances[first : end + 1].min() for end, first in enumerate(firsts)] * whole
    )
    farthest = int(lasting.argmax())
    moved = float(lasting[farthest])
    if moved == 0.0:
        return 0.0, 0.0
    way = along[farthest] / np.linalg.norm(along[farthest])
    spread = float(np.sqrt(np.square(way) @ variances[farthest]))
    return moved, float(normal_share((moved - parameters.moved_m) / spread))


def _shown(track: Track, stretch: Stretch) -> Indices:
    """The frames of a stretch that show the thing."""
    frames = np.arange(stretch.first, stretch.last + 1)
    return frames[track.seen[frames]]


def _taken_up(
    track: Track,
    thing: Thing,
    lying: Stretch,
    held: Stretch,
    parameters: HandlingParameters,
    *,
    goes_on: bool,
) -> list[Achievement]:
    """What is held on, ``goes_on``, and not surely moved yet, may be so in a moment."""
    moved, probability = _moved(track, lying, held, parameters)
    if moved < parameters.moved_m:
        return []
    start = float(track.times[lying.last])
    until = float(track.times[held.first])
    if goes_on and probability < parameters.sure and track.times[-1] - until < parameters.waits_s:
        return []
    probability *= _in_sight(track, lying, held, parameters)
    reach = _reach(track, thing, lying, (start - parameters.reached_s, until))
    if np.isfinite(reach):
        probability *= _reached(reach, parameters)
    evidence = {"moved_m": moved, **_seen(track, lying, held)}
    return [_achievement(TAKEN_UP, start, until, probability, evidence)]


def _put_down(
    track: Track, thing: Thing, held: Stretch, lying: Stretch, parameters: HandlingParameters
) -> list[Achievement]:
    moved, probability = _moved(track, lying, held, parameters)
    place, covariance = _place(track, lying)
    spread = np.sqrt(np.diagonal(covariance))
    times = track.times
    around = np.abs(times - times[lying.first]) <= parameters.longest_fall_s
    hands = track.joints[around][:, HANDS]
    distances = np.linalg.norm(hands - place, axis=-1)
    reached = float(np.nanmin(distances)) if np.isfinite(distances).any() else np.nan
    fall = float(track.positions[held.last, 2] - place[2])
    aside = float(np.linalg.norm(track.positions[held.last, :2] - place[:2]))
    # What falls goes down more than aside; what else is at once elsewhere was never held.
    dropped = min(reached, fall) > parameters.fallen_m and fall > aside
    amounts = {
        f"place_{axis}_m": Amount(float(value), float(error))
        for axis, value, error in zip("xyz", place, spread, strict=True)
    }
    evidence = {"moved_m": moved, "fall_m": fall, **_seen(track, held, lying)}
    if np.isfinite(reached):
        evidence["hand_to_place_m"] = reached
    kind = DROPPED if dropped else PUT_DOWN
    start, end = float(times[held.last]), float(times[lying.first])
    reach = _reach(track, thing, lying, (end - parameters.reached_s, end))
    if np.isfinite(reach) and not dropped:
        probability *= _reached(reach, parameters)
    probability *= _in_sight(track, held, lying, parameters)
    return [_achievement(kind, start, end, probability, evidence, amounts)]


def _in_sight(
    track: Track, before: Stretch, after: Stretch, parameters: HandlingParameters
) -> float:
    """How probably two stretches are of one thing, by how long none was seen between them."""
    between = slice(before.last, after.first + 1)
    seen = track.seen[between]
    hidden_s = np.diff(track.times[between])[~(seen[:-1] & seen[1:])].sum()
    return float(0.5 ** (hidden_s / parameters.hidden_s))


def _reach(track: Track, thing: Thing, lying: Stretch, between: tuple[float, float]) -> float:
    """How near, metres, a hand came to the thing where it lies; NaN where no hand is known."""
    frames = _shown(track, lying)
    place = np.median(track.positions[frames], axis=0)
    usual = int(frames[np.linalg.norm(track.positions[frames] - place, axis=1).argmin()])
    then = (track.times >= between[0]) & (track.times <= between[1])
    count = int(then.sum())
    there = replace(track[then], poses=np.tile(track.poses[usual], (count, 1)))
    distances = hand_distances(there, thing)
    return float(np.nanmin(distances)) if np.isfinite(distances).any() else float("nan")


def _reached(reach: float, parameters: HandlingParameters) -> float:
    return float(normal_share((parameters.reach_m - reach) / parameters.reach_deviation_m))


def _left(track: Track, held: Stretch, parameters: HandlingParameters) -> Achievement:
    """Say that the thing was last seen in somebody's hands; what never moved there only lay near
    a hand."""
    at = float(track.times[held.last])
    share = float(track.seen[held.first : held.last + 1].mean())
    _, carried = _moved(track, held, held, parameters)
    return _achievement(LEFT_IN_USE, at, at, share * carried, {"seen_share": share})


def _seen(track: Track, *stretches: Stretch) -> dict[str, float]:
    frames = np.concatenate([np.arange(one.first, one.last + 1) for one in stretches])
    return {"seen_share": float(track.seen[frames].mean())}


def _achievement(
    kind: str,
    start_s: float,
    end_s: float,
    probability: float,
    evidence: dict[str, float],
    amounts: dict[str, Amount] | None = None,
) -> Achievement:
    return Achievement(kind, start_s, end_s, probability, amounts or {}, evidence)
