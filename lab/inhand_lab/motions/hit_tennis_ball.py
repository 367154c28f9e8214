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
from inhand_lab.motions.performance import (
    Performance,
    Stance,
    feet_apart,
    hanging_hands,
    stand,
    step,
)
from inhand_lab.motions.reaching import (
    PUT_BACK,
    TAKE,
    attention,
    held_by_right_hand,
    named,
    reaching_hand,
)
from inhand_lab.motions.timeline import Key, Move, Pause, Stage, flow, move_through, schedule, track
from inhand_lab.objects.racket import HANDLE_RADIUS
from inhand_lab.people.kinematics import Trunk, place_trunk
from inhand_lab.people.person import SimulatedPerson

OPENING = (*TAKE, Move("lift", 0.9))
USE = (Pause("ready", 0.4), Move("stroke", 1.35), Move("recover", 0.7))
CLOSING = (Pause("ready", 0.3), *PUT_BACK)

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
    stages = schedule(person, random, float(times[-1]), OPENING, USE, CLOSING)
    figures = _figures(person, times, random, stages)
    posture = stand(person, times, random, _stance(person, times, random, stages, figures))
    trunk = place_trunk(person, posture)
    table, lying = _table(person, random)
    grip = _grip(person, times, random)
    played = _play(person, trunk, figures, grip)
    rest = lying.repeated(len(times))
    lift, back = named(stages, "lift"), named(stages, "return")
    carried = move_through(
        times,
        [
            Key(lift.start, rest),
            Key(lift.end, played, bow=(0.0, 0.0, 0.06)),
            Key(back.start, played),
            Key(back.end, rest, bow=(0.0, 0.0, 0.10)),
        ],
    )
    right_rest, left_rest = hanging_hands(person, trunk, random)
    right_hand = reaching_hand(times, stages, right_rest, carried @ grip, bow=(0.08, 0.10, 0.10))
    balancing = _balancing_hand(person, trunk, figures)
    left_hand = move_through(
        times,
        [
            Key(lift.start, left_rest),
            Key(lift.end, balancing, bow=(-0.05, 0.05, 0.0)),
            Key(back.start, balancing),
            Key(back.end, left_rest, bow=(-0.05, 0.05, 0.0)),
        ],
    )
    contact = held_by_right_hand(times, stages)
    return Performance(posture, right_hand, left_hand, carried, contact, table)


def _figures(
    person: SimulatedPerson, times: Array, random: np.random.Generator, stages: list[Stage]
) -> Array:
    """The figures of STROKE over time (T, 12), angles in radians, the wrist in the racket's."""
    knots = [(0.0, READY)]
    for stage in stages:
        if stage.name == "stroke":
            knots += _stroke(person, stage, random)
        if stage.name == "recover":
            knots.append((stage.end, READY))
    figures = flow(times, knots)
    figures[:, DEGREES] = np.radians(figures[:, DEGREES])
    figures[:, RACKET.start] -= figures[:, WRIST]
    return figures


def _stroke(
    person: SimulatedPerson, stage: Stage, random: np.random.Generator
) -> list[tuple[float, Array]]:
    """One stroke, of the person's size and wrist with some variation, at a ball of its own."""
    usual, range_ = LAID_BACK
    wrist = usual + range_ * (0.7 * person.manner.grip_slide + 0.3 * random.normal())
    wrist = np.clip(wrist, *LEAST_AND_MOST_LAID_BACK)
    size = np.clip(person.manner.amplitude * (1.0 + 0.05 * random.normal()), 0.75, 1.15)
    ball = random.normal(0.0, 0.03, 3)
    knots = []
    for share, figures in STROKE:
        values = figures.copy()
        values[HAND] += 4.0 * share * (1.0 - share) * ball
        values[WRIST] *= wrist
        values[TURN] = READY[TURN] + size * (values[TURN] - READY[TURN])
        knots.append((stage.start + share * (stage.end - stage.start), values))
    return knots


def _stance(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    stages: list[Stage],
    figures: Array,
) -> Stance:
    """Knees bent, eyes ahead, the left foot stepping into some of the balls and back."""
    count = len(times)
    lift, back = named(stages, "lift"), named(stages, "return")
    keys = [(lift.start, 0.0), (lift.end, 1.0), (back.start, 1.0), (back.end, 0.0)]
    play, looked = track(times, keys), attention(times, stages)[:, None]
    right_foot, left_foot = feet_apart(count, half_width=0.085 * person.height)
    stepping = random.random() < 0.8
    for stage in stages:
        span = stage.end - stage.start
        if stage.name == "stroke":
            way = stepping * STEP * person.height * random.uniform((-0.1, 0.7), (0.4, 1.2))
            left_foot += step(times, stage.start + 0.25 * span, stage.start + 0.55 * span, way)
        if stage.name == "recover":
            left_foot += step(times, stage.start + 0.3 * span, stage.start + 0.9 * span, -way)
    shift = np.stack([np.zeros(count), np.zeros(count), -0.025 * play], axis=1)
    trunk = play[:, None] * np.stack([figures[:, LEAN], np.zeros(count), figures[:, TURN]], axis=1)
    head = np.stack([0.2 * play, np.zeros(count), -0.8 * trunk[:, 2]], axis=1)
    trunk += looked * np.array([0.30, -0.04, 0.38])
    head += looked * np.array([-0.30, 0.0, 0.30])
    return Stance(right_foot, left_foot, np.zeros(count), shift, trunk, head)


def _table(person: SimulatedPerson, random: np.random.Generator) -> tuple[Furniture, Transform]:
    """A table at the left, and the racket on it, its handle to the right, world_from_object."""
    size = person.height / 1.75
    x, y = np.array([-0.03, 0.44]) * size + random.normal(0.0, 0.015, 2)
    top = 0.50 * person.height + random.normal(0.0, 0.01)
    turn = 1.20 + random.normal(0.0, 0.08)
    lying = _pointing(np.array([turn]), np.zeros(1), np.array([-0.5 * np.pi]))[0]
    head = np.array([x, y]) + 0.42 * np.array([-np.sin(turn), np.cos(turn)])
    place = np.array([x, y, top + HANDLE_RADIUS])
    return side_table(float(head[0]) - 0.02, float(head[1]), float(top)), Transform(place, lying)


def _pointing(to_left: Array, up: Array, roll: Array) -> Array:
    """The racket's rotations (T, 3, 3) that point it in those directions (T,), radians."""
    return rotation_about("xz", up, to_left) @ POINTING_AHEAD @ rotation_about("z", roll)


def _grip(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Transform:
    """A fist whose palm is behind the strings, object_from_hand (T)."""
    square = rotation_about("z", -0.5 * np.pi + 0.5 * person.manner.grip_turn)
    point = np.array([0.0, 0.0, 0.02 * person.manner.grip_slide])
    return hold_bar(person, times, random, point, square @ rotation_about("x", OBLIQUE))


def _play(person: SimulatedPerson, trunk: Trunk, figures: Array, grip: Transform) -> Transform:
    """The racket at play, world_from_object (T), where the arm can reach."""
    centre = trunk.world_from_chest.translation
    hand = centre + figures[:, HAND] * (person.height / 1.75)
    rotation = _pointing(*figures[:, RACKET].T)
    racket = Transform(hand - np.einsum("tij,tj->ti", rotation, grip.translation), rotation)
    shift = overreach(person, trunk.right_shoulder, racket @ grip)
    return Transform(racket.translation + shift, rotation)


def _balancing_hand(person: SimulatedPerson, trunk: Trunk, figures: Array) -> Transform:
    """The left hand, world_from_hand (T): by the racket's throat, ahead, and at the side."""
    centre = trunk.world_from_chest.translation
    place = centre + figures[:, LEFT_HAND] * (person.height / 1.75)
    rotation = rotation_from_axes([0.35, 0.8, 0.15], [0.2, 0.0, 1.0])
    hand = Transform(place, np.tile(rotation, (len(place), 1, 1)))
    return Transform(place + overreach(person, trunk.left_shoulder, hand), hand.rotation)
