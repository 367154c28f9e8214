"""hitTennisBall: take a racket from a side table, hit an imagined ball several times, put it back.

The strokes are forehands from below. How far the wrist lays the racket back behind the hand is the
person's own and differs between strokes: the skeleton hardly shows it.
"""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_about, rotation_from_axes
from inhand_lab.motions.arms import overreach
from inhand_lab.motions.furniture import Furniture, side_table
from inhand_lab.motions.grips import hold_bar
from inhand_lab.motions.performance import Performance, Stance, feet_apart, hanging_hands, step
from inhand_lab.motions.reaching import PUT_BACK, TAKE, attention, carried_by, reaching_hand
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Move, Pause, Plan, Stage
from inhand_lab.objects.racket import HANDLE_RADIUS
from inhand_lab.people.kinematics import Trunk
from inhand_lab.people.person import SimulatedPerson

PLAN = Plan(
    opening=(*TAKE, Move("lift", 0.9)),
    use=(Pause("ready", 0.4), Move("stroke", 1.35, swift=True), Move("recover", 0.7)),
    closing=(Pause("ready", 0.3), *PUT_BACK),
)

READY = np.array((0.06, 0.40, -0.30, 50, 35, 0, 0.0, -0.12, 0.44, -0.24, 4, 12))
STROKE = (
    (0.00, READY),
    (0.26, np.array((0.40, 0.12, -0.26, -45, 35, -5, 0.8, 0.00, 0.46, -0.18, -52, 8))),
    (0.40, np.array((0.46, -0.12, -0.42, -92, 5, -10, 1.0, -0.10, 0.42, -0.20, -62, 10))),
    (0.50, np.array((0.48, -0.05, -0.56, -100, -28, -10, 0.9, -0.18, 0.36, -0.22, -52, 14))),
    (0.60, np.array((0.36, 0.36, -0.46, -70, -14, 0, 0.1, -0.24, 0.26, -0.28, -10, 13))),
    (0.67, np.array((0.20, 0.50, -0.28, -18, 8, 8, 0.0, -0.25, 0.24, -0.30, 10, 11))),
    (0.80, np.array((-0.14, 0.42, -0.02, 62, 35, 15, 0.0, -0.26, 0.18, -0.30, 32, 8))),
    (1.00, np.array((-0.20, 0.34, 0.04, 105, 48, 20, 0.0, -0.26, 0.16, -0.32, 38, 6))),
)
"""Shares of a stroke's time and then: the right hand from the shoulders' centre, metres (3); where
the racket points, to the left of ahead and up, and the roll of its face, degrees (3); how far the
wrist may be laid back (1); the left hand, metres (3); turn of the chest to the left and its lean,
degrees (2)."""
HAND, RACKET, WRIST, LEFT_HAND, TURN, LEAN = slice(0, 3), slice(3, 6), 6, slice(7, 10), 10, 11
DEGREES = [3, 4, 5, 10, 11]

LAID_BACK = np.radians(22.0), np.radians(40.0)
LEAST_AND_MOST_LAID_BACK = np.radians((-15.0, 48.0))
"""How far people lay the wrist back, and how much further or less some of them do."""
OBLIQUE = np.radians(42.0)
"""Of the handle across the palm."""
POINTING_AHEAD = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]])
"""A racket that points ahead with its face to the left, in the person's world."""
STEP = 0.13
"""Of the left foot into the ball, in statures."""


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Tennis at these times, in seconds from the start; the ball comes from ahead."""
    script = write_script(person, times, random, PLAN)
    figures = _figures(script)
    posture, trunk = script.stand(_stance(script, figures))
    table, lying = _table(script)
    grip = _grip(script)
    rest, played = script.still(lying), _play(script, trunk, figures, grip)
    lift, back = To(played, bow=(0.0, 0.0, 0.06)), To(rest, bow=(0.0, 0.0, 0.10))
    carried = script.way(rest, {"lift": lift, "return": back})
    right_rest, left_rest = hanging_hands(person, trunk, random)
    right_hand = reaching_hand(script, right_rest, carried @ grip, bow=(0.08, 0.10, 0.10))
    balance = To(_balancing_hand(script, trunk, figures), bow=(-0.05, 0.05, 0.0))
    hang = To(left_rest, bow=(-0.05, 0.05, 0.0))
    left_hand = script.way(left_rest, {"lift": balance, "return": hang})
    return Performance(
        posture, right_hand, left_hand, carried, carried_by(script), table, script.stages
    )


def _figures(script: Script) -> Array:
    """The figures of STROKE over time (T, 12), angles in radians, the wrist in the racket's."""
    knots = [(0.0, READY)]
    for stage in script.every("stroke", "recover"):
        knots += _stroke(script, stage) if stage.name == "stroke" else [(stage.end, READY)]
    figures = script.flow(knots)
    figures[:, DEGREES] = np.radians(figures[:, DEGREES])
    figures[:, RACKET.start] -= figures[:, WRIST]
    return figures


def _stroke(script: Script, stage: Stage) -> list[tuple[float, Array]]:
    """One stroke, of the person's size and wrist with some variation, at a ball of its own."""
    manner, random = script.person.manner, script.random
    usual, more = LAID_BACK
    wrist = usual + more * (0.7 * manner.grip_slide + 0.3 * random.normal())
    wrist = np.clip(wrist, *LEAST_AND_MOST_LAID_BACK)
    size = np.clip(manner.amplitude * (1.0 + 0.05 * random.normal()), 0.75, 1.15)
    ball = random.normal(0.0, 0.03, 3)
    knots = []
    for share, figures in STROKE:
        values = figures.copy()
        values[HAND] += 4.0 * share * (1.0 - share) * ball
        values[WRIST] *= wrist
        values[TURN] = READY[TURN] + size * (values[TURN] - READY[TURN])
        knots.append((stage.at(share), values))
    return knots


def _stance(script: Script, figures: Array) -> Stance:
    """Knees bent, eyes ahead, the left foot stepping into some of the balls and back."""
    height, times, random = script.person.height, script.times, script.random
    play, looked = script.level(0.0, {"lift": 1.0, "return": 0.0}), attention(script)
    right_foot, left_foot = feet_apart(script.person, len(times), 0.085 * height)
    stepping = random.random() < 0.8
    for stage in script.every("stroke", "recover"):
        if stage.name == "stroke":
            way = stepping * STEP * height * random.uniform((-0.1, 0.7), (0.4, 1.2))
            left_foot += step(times, stage.at(0.25), stage.at(0.55), way)
        else:
            left_foot += step(times, stage.at(0.3), stage.at(0.9), -way)
    still = np.zeros(len(times))
    trunk = play[:, None] * np.stack([figures[:, LEAN], still, figures[:, TURN]], axis=1)
    head = np.stack([0.2 * play, still, -0.8 * trunk[:, 2]], axis=1)
    trunk += np.outer(looked, [0.30, -0.04, 0.38])
    head += np.outer(looked, [-0.30, 0.0, 0.30])
    shift = np.outer(play, [0.0, 0.0, -0.025])
    return Stance(right_foot, left_foot, still, shift, trunk, head)


def _table(script: Script) -> tuple[Furniture, Transform]:
    """A table at the left, and the racket on it, its handle to the right, world_from_object."""
    x, y = script.place(-0.03, 0.44)
    top = script.table_top(0.50, spread=0.01)
    turn = 1.20 + script.random.normal(0.0, 0.08)
    lying = _pointing(np.array([turn]), np.zeros(1), np.array([-0.5 * np.pi]))[0]
    head = np.array([x, y]) + 0.42 * np.array([-np.sin(turn), np.cos(turn)])
    place = np.array([x, y, top + HANDLE_RADIUS])
    return side_table(float(head[0]) - 0.02, float(head[1]), top), Transform(place, lying)


def _pointing(to_left: Array, up: Array, roll: Array) -> Array:
    """The racket's rotations (T, 3, 3) that point it in those directions (T,), radians."""
    return rotation_about("xz", up, to_left) @ POINTING_AHEAD @ rotation_about("z", roll)


def _grip(script: Script) -> Transform:
    """A fist whose palm is behind the strings, object_from_hand (T)."""
    manner = script.person.manner
    square = rotation_about("z", -0.5 * np.pi + 0.5 * manner.grip_turn)
    point = np.array([0.0, 0.0, 0.02 * manner.grip_slide])
    return hold_bar(script, point, square @ rotation_about("x", OBLIQUE))


def _play(script: Script, trunk: Trunk, figures: Array, grip: Transform) -> Transform:
    """The racket at play, world_from_object (T), where the arm can reach."""
    hand = trunk.world_from_chest.translation + figures[:, HAND] * script.size
    rotation = _pointing(*figures[:, RACKET].T)
    racket = Transform(hand - np.einsum("tij,tj->ti", rotation, grip.translation), rotation)
    shift = overreach(script.person, trunk.right_shoulder, racket @ grip)
    return Transform(racket.translation + shift, rotation)


def _balancing_hand(script: Script, trunk: Trunk, figures: Array) -> Transform:
    """The left hand, world_from_hand (T): by the racket's throat, ahead, and at the side."""
    place = trunk.world_from_chest.translation + figures[:, LEFT_HAND] * script.size
    rotation = rotation_from_axes([0.35, 0.8, 0.15], [0.2, 0.0, 1.0])
    hand = Transform(place, np.tile(rotation, (len(place), 1, 1)))
    shift = overreach(script.person, trunk.left_shoulder, hand)
    return Transform(place + shift, hand.rotation)
