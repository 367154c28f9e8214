"""hammerNail: drive a nail into a block on a bench, with light taps while it is held, then hard."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import MIRROR, Transform, rotation_about, rotation_from_axes
from inhand_lab.motions.furniture import Cuboid, Furniture, side_table
from inhand_lab.motions.grips import hold_bar, pinch
from inhand_lab.motions.performance import Performance, Stance, hanging_hands, upright
from inhand_lab.motions.reaching import PUT_BACK, TAKE, carried_by, reaching_hand
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Move, Pause, Plan, minimum_jerk
from inhand_lab.objects.hammer import FACE_REACH, HAMMER_HALF_LENGTH, HEAD_HEIGHT
from inhand_lab.people.kinematics import Trunk
from inhand_lab.people.person import SimulatedPerson

PLAN = Plan(
    opening=(*TAKE, Move("lift", 0.85), Move("tap", 1.2, swift=True), Move("let go", 0.5)),
    use=(Move("strike", 1.75, swift=True), Pause("look", 0.4)),
    closing=PUT_BACK,
)

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
AROUND_NAIL = (-0.02, -0.03, 0.05)
"""How its ways to the bench and to the nail, and back, swing out, metres."""
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
    script = write_script(person, times, random, PLAN)
    strokes = list(_strokes(script))
    swung = _swung(script, strokes)
    posture, trunk = script.stand(_stance(script, swung))
    bench = _bench(script)
    nail = bench.base + np.outer(_standing(script, strokes), [0.0, 0.0, 1.0])
    striking = _strike(script, trunk, nail, swung)
    first, last = (script.still(_lying(random, bench.spot)) for _ in range(2))
    lift, back = To(striking, bow=(0.04, -0.02, 0.10)), To(last, bow=(0.04, -0.02, 0.10))
    carried = script.way(first, {"lift": lift, "return": back})
    right_rest, left_rest = hanging_hands(person, trunk, random)
    held = carried @ _grip(script)
    right_hand = reaching_hand(script, right_rest, held, bow=(0.05, -0.14, 0.16))
    left_hand = _hold_nail(script, left_rest, bench.base)
    contact = carried_by(script)
    return Performance(
        posture, right_hand, left_hand, carried, contact, bench.furniture, script.stages
    )


def _strokes(script: Script) -> Iterator[Stroke]:
    """The strokes of every burst in order of time."""
    random = script.random
    for stage in script.every(*STROKES):
        count = STROKES[stage.name]
        beat = stage.seconds / count
        for start in stage.start + beat * np.arange(count):
            back = BACKSWING * float(np.exp(random.normal(0.0, 0.06)))
            swing = SWING[stage.name] * script.person.manner.amplitude
            swing = min(swing * float(np.exp(random.normal(0.0, 0.10))), WIDEST_SWING)
            yield Stroke(float(start), float(start + back * beat), float(start + beat), swing)


def _swung(script: Script, strokes: list[Stroke]) -> Array:
    """How far (T,) the hammer is swung back from the nail, radians."""
    times = script.times
    swung = HOVERING * (1.0 + script.drift(0.2, 2.0))
    for stage in script.every(*STROKES):
        swung *= 1.0 - script.around(stage, 0.25, 0.25)
    for stroke in strokes:
        risen = minimum_jerk((times - stroke.start) / (stroke.top - stroke.start))
        fallen = np.clip((times - stroke.top) / (stroke.impact - stroke.top), 0.0, 1.0) ** 2
        swung += stroke.swing * (risen - fallen)
    return np.asarray(swung)


def _standing(script: Script, strokes: list[Stroke]) -> Array:
    """Height (T,) of the nail's head above the block: each stroke drives it as far as it swings."""
    work = np.cumsum([stroke.swing for stroke in strokes])
    depths = NAIL_STANDING + (NAIL_DRIVEN - NAIL_STANDING) * work / work[-1]
    keys = [(0.0, NAIL_STANDING)]
    for stroke, depth in zip(strokes, depths, strict=True):
        keys += [(stroke.top, keys[-1][1]), (stroke.impact, float(depth))]
    return script.track(keys)


def _stance(script: Script, swung: Array) -> Stance:
    """Leaning over the nail, most to hold it, and the trunk going a little with the strokes."""
    worked = script.level(0.0, {"lift": 1.0, "return": 0.0})
    holding = script.level(0.0, {"lift": 1.0, "let go": 0.0})
    late = (0.3, 1.0)
    bending = {"reach": 1.0, "lift": 0.0, "return": 1.0, "withdraw": 0.0}
    bent = script.level(0.0, bending, parts={"lift": late, "withdraw": late})
    trunk = np.outer(bent, [0.60, 0.06, -0.18]) + np.outer(worked, [0.24, 0.0, -0.16])
    trunk += np.outer(holding, [0.14, 0.0, -0.04])
    trunk -= np.outer(worked * swung, [0.05, -0.02, 0.08])
    head = np.outer(bent, [-0.25, 0.0, -0.25]) + np.outer(worked, [-0.38, 0.0, 0.0])
    return script.upright_stance(trunk, head, half_width=0.12)


def _bench(script: Script) -> Bench:
    """A bench ahead, of the height of a dining table."""
    top = script.table_top(0.45)
    x, y = script.place(0.06, 0.55, spread=0.012)
    wide, deep, high = BLOCK_SIZE
    block = Cuboid((x, y, top + high / 2.0), (wide, deep, high), PINE)
    beside = np.array([x + 0.24, 0.40 * script.size]) + script.random.normal(0.0, 0.012, 2)
    return Bench(
        (*side_table(x + 0.10, y + 0.01, top, width=0.80), block),
        np.array([*beside, top + 0.018]),
        np.array([x, y, top + high]),
    )


def _lying(random: np.random.Generator, spot: Array) -> Transform:
    """The hammer on its side, its head ahead and to the left, world_from_object."""
    turned = rotation_about("z", 0.6 + random.normal(0.0, 0.08))
    on_side = rotation_from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    aside = np.append(random.normal(0.0, 0.008, 2), 0.0)
    return Transform(spot + aside, turned @ on_side)


def _grip(script: Script) -> Transform:
    """A fist near the handle's end, object_from_hand (T)."""
    manner = script.person.manner
    point = np.array([0.0, 0.0, GRIP_HEIGHT + 0.03 * max(manner.grip_slide, -0.3)])
    return hold_bar(script, point, rotation_about("xz", OBLIQUE, 0.4 * manner.grip_turn))


def _strike(script: Script, trunk: Trunk, nail: Array, swung: Array) -> Transform:
    """The hammer's way, world_from_object (T): swung about the elbow and, further, the wrist."""
    sideways = rotation_about("z", HANDLE_TO_LEFT + script.drift(0.04, 3.0))
    missed = script.drifts(0.003, 1.5)
    rising = 0.4 * script.person.manner.grip_tilt + script.drift(0.03, 2.0)
    level = rotation_from_axes([0.0, 0.0, -1.0], [0.0, 1.0, 0.0])
    at_impact = sideways @ rotation_about("x", rising) @ level
    hit = nail + missed * [1.0, 1.0, 0.0]
    hand = np.array([0.0, 0.0, GRIP_HEIGHT])
    grasped = hit + at_impact @ (hand - FACE)
    chest = upright(trunk.world_from_chest)
    elbow = trunk.right_shoulder + chest.rotation @ (ELBOW * script.size)
    by_elbow = sideways @ rotation_about("x", ELBOW_SHARE * swung) @ np.swapaxes(sideways, 1, 2)
    by_both = sideways @ rotation_about("x", swung) @ np.swapaxes(sideways, 1, 2)
    shrugged = np.outer(swung, [0.02, -0.03, 0.04])
    swinging = elbow + shrugged + np.einsum("tij,tj->ti", by_elbow, grasped - elbow)
    rotation = by_both @ at_impact
    return Transform(swinging - rotation @ hand, rotation)


def _hold_nail(script: Script, rest: Transform, base: Array) -> Transform:
    """The left hand, world_from_hand (T): on the bench, but at the nail until that stands."""
    held = (base + np.array([0.0, 0.0, HELD_AT])) * MIRROR
    holding = Transform(held, np.eye(3)) @ pinch(script, np.zeros(3), HOLDING)
    own = np.append(script.random.normal(0.0, 0.015, 2), -BLOCK_SIZE[2])
    leaning = script.still(Transform((base + LEANING_AT + own) * MIRROR, LEANING)).mirrored()
    goals = {
        "reach": To(leaning, bow=AROUND_BENCH),
        "lift": To(holding.mirrored(), bow=AROUND_NAIL),
        "let go": To(leaning, bow=AROUND_NAIL),
        "withdraw": To(rest, bow=AROUND_BENCH),
    }
    return script.way(rest, goals)
