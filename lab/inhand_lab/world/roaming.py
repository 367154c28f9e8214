"""People who walk about and turn while they use a thing that they carry.

The whole performance goes along rigidly, body, hands and object, from when the thing has been taken
until it is brought back; furniture stays. Feet step: each stands where the body's way has it at the
middle of its stand, then swings to the next such place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_about
from inhand_lab.motions.furniture import Cuboid, Furniture
from inhand_lab.motions.performance import Performance
from inhand_lab.motions.timeline import Stage, minimum_jerk, track
from inhand_lab.people.kinematics import Posture
from inhand_lab.people.person import Proportions, SimulatedPerson
from inhand_lab.world.parameters import DEFAULT_ROAMING

ROAMING_INTERACTIONS = (
    "drinkFromMug",
    "answerPhone",
    "recordVideo",
    "liftWeights",
    "playFlute",
    "hitTennisBall",
    "putOnGlasses",
    "sweepFloor",
)
"""What can be done while walking about: no furniture is used between taking and bringing back."""


@dataclass(frozen=True)
class Way:
    """Where somebody is over T frames: ``turn`` (T,) to the left in radians, ``place`` (T, 2) on
    the floor in metres, from where they were at first."""

    turn: Array
    place: Array

    def transform(self, height: Array) -> Transform:
        """What moves what stood at first, by heights (T,) in metres besides."""
        return Transform(
            np.concatenate([self.place, height[:, None]], axis=1), rotation_about("z", self.turn)
        )


@dataclass(frozen=True)
class WayPoint:
    """Where somebody rests at a time, seconds: a turn to the left and a place on the floor.

    The turn there is over, and the next begins, while the body still walks: ``turned`` and
    ``turning`` are these times.
    """

    time: float
    turned: float
    turning: float
    turn: float
    place: tuple[float, float]


def roam(
    person: SimulatedPerson,
    done: Performance,
    vertices: Array,
    times: Array,
    random: np.random.Generator,
) -> Performance:
    """The performance at times (T,), done while walking about with an object of vertices (V, 3)."""
    return walk_along(person, done, vertices, times, _keys(done, random))


def walk_along(
    person: SimulatedPerson,
    done: Performance,
    vertices: Array,
    times: Array,
    keys: Sequence[WayPoint],
) -> Performance:
    """The performance at times (T,), done on a way, with an object of vertices (V, 3).

    Hips go down where a step needs it, hands and object with them, but nothing into the floor.
    """
    body = _way(times, keys)
    right, left = (_stepping(times, keys, side, done.posture) for side in (0, 1))
    level = body.transform(np.zeros(len(times)))
    dip = _dip(person.proportions, level @ done.posture.world_from_pelvis, right, left)
    moved = body.transform(-dip)
    above = done.world_from_object
    lowest = above.translation[:, 2] + (above.rotation[:, 2] @ vertices.T).min(axis=1)
    carried = body.transform(-np.minimum(dip, np.maximum(lowest, 0.0)))
    posture = replace(
        done.posture,
        world_from_pelvis=moved @ done.posture.world_from_pelvis,
        world_from_right_foot=right,
        world_from_left_foot=left,
    )
    return replace(
        done,
        posture=posture,
        right_hand=carried @ done.right_hand,
        left_hand=carried @ done.left_hand,
        world_from_object=carried @ done.world_from_object,
    )


def _keys(done: Performance, random: np.random.Generator) -> list[WayPoint]:
    """Places to go to in turn, from the first one and back to it."""
    start, end = _carried(done.stages)
    roaming = DEFAULT_ROAMING
    bounds = np.linspace(start, end, max(round((end - start) / roaming.leg_s), 2) + 1)
    keys = [WayPoint(start, start, start + roaming.aloof * (bounds[1] - start), 0.0, (0.0, 0.0))]
    # Nobody turns beside the furniture that they come from and go back to.
    last_turned = end - roaming.aloof * (end - bounds[-2])
    side = random.choice([-1.0, 1.0])
    for time in bounds[1:-1]:
        left = last_turned - time
        before = keys[-1]
        most = roaming.turning * (time - before.turning)
        low = max(before.turn - most, -roaming.turning * left)
        high = min(before.turn + most, roaming.turning * left)
        turn = np.clip(side * random.uniform(*roaming.turned), low, high)
        step = roaming.walking * (time - before.time)
        reach = min(roaming.radius, roaming.walking * (end - time))
        place = _place(random, done.furniture, np.array(before.place), step, reach)
        keys.append(WayPoint(time, time, time, float(turn), place))
        side = -side if abs(turn) >= roaming.turned[0] else side
    return [*keys, WayPoint(end, last_turned, end, 0.0, (0.0, 0.0))]


def _carried(stages: Sequence[Stage]) -> tuple[float, float]:
    """From when to when a thing that was taken is not yet brought back, seconds."""
    names = [stage.name for stage in stages]
    return stages[names.index("grasp") + 1].end, stages[names.index("return")].start


def _place(
    random: np.random.Generator, furniture: Furniture, here: Array, step: float, reach: float
) -> tuple[float, float]:
    """A place no farther than a step from here and than a reach from the first one, metres; of
    those that are tried the first that is clear of furniture, or else the clearest."""
    roaming = DEFAULT_ROAMING
    tried = [(0.0, here * min(1.0, reach / max(float(np.linalg.norm(here)), 1e-9)))]
    for _ in range(roaming.tries):
        place = random.uniform(-roaming.radius, roaming.radius, 2)
        way = place - here
        place = here + way * min(1.0, step / float(np.linalg.norm(way)))
        place *= min(1.0, reach / float(np.linalg.norm(place)))
        clear = min((_clearance(box, place) for box in furniture), default=np.inf)
        tried.append((min(clear, roaming.clearance), place))
    best = max(tried, key=lambda one: one[0])[1]
    return float(best[0]), float(best[1])


def _clearance(box: Cuboid, place: Array) -> float:
    """Distance on the floor between a place (2,) and a box, metres."""
    apart = np.abs(place - box.centre[:2]) - 0.5 * np.array(box.size[:2])
    return float(np.linalg.norm(np.maximum(apart, 0.0)))


def _way(times: Array, keys: Sequence[WayPoint]) -> Way:
    turns = [(keys[0].turning, keys[0].turn)]
    for before, key in pairwise(keys):
        if before.turning > turns[-1][0]:
            turns.append((before.turning, before.turn))
        turns.append((key.turned, key.turn))
    return Way(track(times, turns), track(times, [(key.time, key.place) for key in keys]))


def _stepping(times: Array, keys: Sequence[WayPoint], side: int, posture: Posture) -> Transform:
    """One foot, world_from_foot (T): the right one's (0) steps and the left one's (1) alternate."""
    roaming = DEFAULT_ROAMING
    beat = 1.0 / roaming.cadence
    landings = np.arange(keys[0].time + side * beat, keys[-1].time + 3.0 * beat, 2.0 * beat)
    stands = _way(np.concatenate([[keys[0].time], landings + beat]), keys)
    turn = np.full(len(times), stands.turn[0])
    place = np.repeat(stands.place[:1], len(times), axis=0)
    lift = np.zeros(len(times))
    changes = zip(landings, np.diff(stands.turn), np.diff(stands.place, axis=0), strict=True)
    for landing, turned, moved in changes:
        share = minimum_jerk((times - landing) / (roaming.swing * beat) + 1.0)
        turn += share * turned
        place += share[:, None] * moved
        height = min(roaming.lift, float(np.linalg.norm(moved)) + roaming.pivot * abs(turned))
        lift += height * 4.0 * share * (1.0 - share)
    feet = (posture.world_from_right_foot, posture.world_from_left_foot)
    return Way(turn, place).transform(lift) @ feet[side]


def _dip(body: Proportions, pelvis: Transform, right: Transform, left: Transform) -> Array:
    """How much lower (T,) the hips must be for both legs to reach their feet, metres."""
    length = DEFAULT_ROAMING.straightest * (body.thigh + body.shank)
    dips = []
    for side, foot in ((1.0, right), (-1.0, left)):
        hip = pelvis.apply(np.array([side * body.hip_half_width, 0.0, -body.hip_drop]))
        apart = hip - foot.apply(np.array([0.0, 0.0, body.ankle]))
        span = np.sum(apart[:, :2] ** 2, axis=1)
        dips.append(apart[:, 2] - np.sqrt(np.maximum(length**2 - span, 0.0)))
    return np.asarray(np.maximum(np.maximum(*dips), 0.0))
