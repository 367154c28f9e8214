"""hammerNail: drive a nail into a block on a bench, with light taps while it is held, then hard."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import MIRROR, Transform, rotation_about, rotation_from_axes
from inhand_lab.motions.furniture import Cuboid, Furniture, side_table
from inhand_lab.motions.grips import hold_bar, pinch
from inhand_lab.motions.performance import (
    Performance,
    Stance,
    feet_apart,
    hanging_hands,
    heading_of,
    stand,
)
from inhand_lab.motions.reaching import (
    PUT_BACK,
    TAKE,
    held_by_right_hand,
    named,
    reaching_hand,
)
from inhand_lab.motions.timeline import (
    Key,
    Move,
    Pause,
    Stage,
    drift,
    minimum_jerk,
    move_through,
    schedule,
    track,
)
from inhand_lab.objects.hammer import FACE_REACH, HAMMER_HALF_LENGTH, HEAD_HEIGHT
from inhand_lab.people.kinematics import Trunk, place_trunk
from inhand_lab.people.person import SimulatedPerson

OPENING = (
    *TAKE,
    Move("lift", 0.85),
    Move("tap", 1.2),
    Move("let go", 0.5),
)
USE = (Move("strike", 1.75), Pause("look", 0.4))
CLOSING = PUT_BACK

STROKES = {"tap": 3, "strike": 3}
SWING = {"tap": 0.45, "strike": 1.0}
"""How far the hammer swings back in a stroke, radians."""
WIDEST_SWING = 1.15
HOVERING = 0.22
"""How far it is lifted between the bursts."""
BACKSWING = 0.56
"""The backswing's share of a stroke's time; then the hammer falls ever faster until it hits."""
ELBOW_SHARE = 0.50
"""The elbow's share of the swing; the rest is the wrist's."""

OBLIQUE = 0.48
"""A hammer lies across the palm more obliquely than other handles, radians."""
GRIP_HEIGHT = -HAMMER_HALF_LENGTH + 0.055
FACE = np.array([0.0, FACE_REACH, HEAD_HEIGHT])
HANDLE_TO_LEFT = 0.38
"""Where the handle points at impact, as a turn to the left from straight ahead, radians."""
ELBOW = np.array([0.06, -0.04, -0.27])
"""About where the elbow is at impact, from the shoulder, metres."""

NAIL_STANDING, NAIL_DRIVEN = 0.055, 0.010
"""Length of the nail above the block at first and at last."""
HELD_AT = 0.022
HOLDING = rotation_from_axes([-0.85, 0.35, -0.35], [0.0, -0.8, 0.5])
LEANING = rotation_from_axes([-0.25, 0.95, -0.25], [-1.0, -0.25, 0.0])
"""Rotations of the other hand, mirrored, that holds the nail and then leans on the bench."""
LEANING_AT = np.array([-0.19, -0.19, 0.05])
"""Where it leans, from the foot of the block."""
AROUND_BENCH = (-0.06, -0.14, 0.16)
"""How its way to the bench and back swings out."""
BLOCK_SIZE = (0.12, 0.12, 0.06)
PINE = (216, 182, 126)


@dataclass(frozen=True)
class Stroke:
    """A stroke's times in seconds, and how far the hammer swings back, radians."""

    start: float
    top: float
    impact: float
    swing: float


@dataclass(frozen=True)
class Bench:
    """A bench with the hammer and a block; the nail stands in the block's top at base (3,)."""

    furniture: Furniture
    spot: Array
    base: Array


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Hammering at these times, in seconds from the start."""
    stages = schedule(person, random, float(times[-1]), OPENING, USE, CLOSING)
    strokes = list(_strokes(person, random, stages))
    swung = _swung(times, random, stages, strokes)
    posture = stand(person, times, random, _stance(times, stages, swung))
    trunk = place_trunk(person, posture)
    bench = _bench(person, random)
    nail = bench.base + np.outer(_standing(times, strokes), [0.0, 0.0, 1.0])
    striking = _strike(person, times, random, trunk, nail, swung)
    first, last = (_lying(random, bench.spot).repeated(len(times)) for _ in range(2))
    lift, back = named(stages, "lift"), named(stages, "return")
    carried = move_through(
        times,
        [
            Key(lift.start, first),
            Key(lift.end, striking, bow=(0.04, -0.02, 0.10)),
            Key(back.start, striking),
            Key(back.end, last, bow=(0.04, -0.02, 0.10)),
        ],
    )
    right_rest, left_rest = hanging_hands(person, trunk, random)
    held = carried @ _grip(person, times, random)
    return Performance(
        posture,
        reaching_hand(times, stages, right_rest, held, bow=(0.05, -0.14, 0.16)),
        _hold_nail(times, random, left_rest, bench.base, stages),
        carried,
        held_by_right_hand(times, stages),
        bench.furniture,
    )


def _strokes(
    person: SimulatedPerson, random: np.random.Generator, stages: list[Stage]
) -> Iterator[Stroke]:
    """The strokes of every burst in order of time."""
    for stage in stages:
        if stage.name in STROKES:
            count = STROKES[stage.name]
            beat = (stage.end - stage.start) / count
            for start in stage.start + beat * np.arange(count):
                back = BACKSWING * float(np.exp(random.normal(0.0, 0.06)))
                swing = SWING[stage.name] * person.manner.amplitude
                swing = min(swing * float(np.exp(random.normal(0.0, 0.10))), WIDEST_SWING)
                yield Stroke(float(start), float(start + back * beat), float(start + beat), swing)


def _swung(
    times: Array, random: np.random.Generator, stages: list[Stage], strokes: list[Stroke]
) -> Array:
    """How far (T,) the hammer is swung back from the nail, radians."""
    swung = HOVERING * (1.0 + drift(times, random, 0.2, 2.0))
    for name in STROKES:
        for stage in stages:
            if stage.name == name:
                keys = [(stage.start - 0.25, 1.0), (stage.start, 0.0), (stage.end, 0.0)]
                swung *= track(times, [*keys, (stage.end + 0.25, 1.0)])
    for stroke in strokes:
        risen = minimum_jerk((times - stroke.start) / (stroke.top - stroke.start))
        fallen = np.clip((times - stroke.top) / (stroke.impact - stroke.top), 0.0, 1.0) ** 2
        swung += stroke.swing * (risen - fallen)
    return np.asarray(swung)


def _standing(times: Array, strokes: list[Stroke]) -> Array:
    """Height (T,) of the nail's head above the block: each stroke drives it as far as it swings."""
    work = np.cumsum([stroke.swing for stroke in strokes])
    depths = NAIL_STANDING + (NAIL_DRIVEN - NAIL_STANDING) * work / work[-1]
    keys = [(0.0, NAIL_STANDING)]
    for stroke, depth in zip(strokes, depths, strict=True):
        keys += [(stroke.top, keys[-1][1]), (stroke.impact, float(depth))]
    return track(times, keys)


def _stance(times: Array, stages: list[Stage], swung: Array) -> Stance:
    """Leaning over the nail, most to hold it, and the trunk going a little with the strokes."""
    count = len(times)
    lift, back = named(stages, "lift"), named(stages, "return")
    keys = [(lift.start, 0.0), (lift.end, 1.0), (back.start, 1.0), (back.end, 0.0)]
    worked = track(times, keys)[:, None]
    looked = _bending(times, stages)[:, None]
    leave = named(stages, "let go")
    keys = [(lift.start, 0.0), (lift.end, 1.0), (leave.start, 1.0), (leave.end, 0.0)]
    holding = track(times, keys)[:, None]
    trunk = looked * np.array([0.60, 0.06, -0.18]) + worked * np.array([0.24, 0.0, -0.16])
    trunk += holding * np.array([0.14, 0.0, -0.04])
    trunk -= worked * swung[:, None] * np.array([0.05, -0.02, 0.08])
    head = looked * np.array([-0.25, 0.0, -0.25]) + worked * np.array([-0.38, 0.0, 0.0])
    right_foot, left_foot = feet_apart(count, half_width=0.12)
    return Stance(right_foot, left_foot, np.zeros(count), np.zeros((count, 3)), trunk, head)


def _bending(times: Array, stages: list[Stage]) -> Array:
    """How much (T,), 0 to 1, somebody bends over to where the hammer lies."""
    bent = np.zeros(len(times))
    for there, away in (("reach", "lift"), ("return", "withdraw")):
        reaching, leaving = named(stages, there), named(stages, away)
        late = leaving.start + 0.3 * (leaving.end - leaving.start)
        bent += track(
            times,
            [
                (reaching.start, 0.0),
                (reaching.end, 1.0),
                (late, 1.0),
                (leaving.end, 0.0),
            ],
        )
    return bent


def _bench(person: SimulatedPerson, random: np.random.Generator) -> Bench:
    """A bench ahead, of the height of a dining table."""
    size = person.height / 1.75
    top = 0.45 * person.height + float(random.normal(0.0, 0.015))
    x, y = np.array([0.06, 0.55]) * size + random.normal(0.0, 0.012, 2)
    wide, deep, high = BLOCK_SIZE
    block = Cuboid((x, y, top + high / 2.0), (wide, deep, high), PINE)
    across, ahead = np.array([x + 0.24, 0.40 * size]) + random.normal(0.0, 0.012, 2)
    return Bench(
        (*side_table(x + 0.10, y + 0.01, top, width=0.80), block),
        np.array([across, ahead, top + 0.018]),
        np.array([x, y, top + high]),
    )


def _lying(random: np.random.Generator, spot: Array) -> Transform:
    """The hammer on its side, its head ahead and to the left, world_from_object."""
    turned = rotation_about("z", 0.6 + random.normal(0.0, 0.08))
    on_side = rotation_from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    aside = np.append(random.normal(0.0, 0.008, 2), 0.0)
    return Transform(spot + aside, turned @ on_side)


def _grip(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Transform:
    """A fist near the handle's end, object_from_hand (T)."""
    point = np.array([0.0, 0.0, GRIP_HEIGHT + 0.03 * max(person.manner.grip_slide, -0.3)])
    turned = rotation_about("xz", OBLIQUE, 0.4 * person.manner.grip_turn)
    return hold_bar(person, times, random, point, turned)


def _strike(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    trunk: Trunk,
    nail: Array,
    swung: Array,
) -> Transform:
    """The hammer's way, world_from_object (T): swung about the elbow and, further, the wrist."""
    sideways = rotation_about("z", HANDLE_TO_LEFT + drift(times, random, 0.04, 3.0))
    missed = np.stack([drift(times, random, 0.003, 1.5) for _ in range(3)], axis=1)
    rising = 0.4 * person.manner.grip_tilt + drift(times, random, 0.03, 2.0)
    level = rotation_from_axes([0.0, 0.0, -1.0], [0.0, 1.0, 0.0])
    at_impact = sideways @ rotation_about("x", rising) @ level
    hit = nail + missed * [1.0, 1.0, 0.0]
    hand = np.array([0.0, 0.0, GRIP_HEIGHT])
    grasped = hit + at_impact @ (hand - FACE)
    upright = rotation_about("z", heading_of(trunk.world_from_chest))
    elbow = trunk.right_shoulder + upright @ (ELBOW * person.height / 1.75)
    by_elbow = sideways @ rotation_about("x", ELBOW_SHARE * swung) @ np.swapaxes(sideways, 1, 2)
    by_both = sideways @ rotation_about("x", swung) @ np.swapaxes(sideways, 1, 2)
    shrugged = np.outer(swung, [0.02, -0.03, 0.04])
    swinging = elbow + shrugged + np.einsum("tij,tj->ti", by_elbow, grasped - elbow)
    rotation = by_both @ at_impact
    return Transform(swinging - rotation @ hand, rotation)


def _hold_nail(
    times: Array,
    random: np.random.Generator,
    rest: Transform,
    base: Array,
    stages: list[Stage],
) -> Transform:
    """The left hand, world_from_hand (T): on the bench, but at the nail until that stands."""
    held = (base + np.array([0.0, 0.0, HELD_AT])) * MIRROR
    holding = Transform(held, np.eye(3)) @ pinch(times, random, np.zeros(3), HOLDING)
    own = np.append(random.normal(0.0, 0.015, 2), -BLOCK_SIZE[2])
    leaning = Transform((base + LEANING_AT + own) * MIRROR, LEANING).repeated(len(times))
    reach, lift, leave, away = (
        named(stages, name) for name in ("reach", "lift", "let go", "withdraw")
    )
    return move_through(
        times,
        [
            Key(reach.start, rest),
            Key(reach.end, leaning.mirrored(), bow=AROUND_BENCH),
            Key(lift.start, leaning.mirrored()),
            Key(lift.end, holding.mirrored(), bow=(-0.02, -0.03, 0.05)),
            Key(leave.start, holding.mirrored()),
            Key(leave.end, leaning.mirrored(), bow=(-0.02, -0.03, 0.05)),
            Key(away.start, leaning.mirrored()),
            Key(away.end, rest, bow=AROUND_BENCH),
        ],
    )
