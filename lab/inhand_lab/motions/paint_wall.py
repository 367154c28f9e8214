"""paintWall: take a brush out of a pot, paint a board, dip now and then, put the brush back.

The brush keeps about the same angle to the board while hand and forearm turn with every stroke: it
is no rigid extension of the forearm.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_about
from inhand_lab.motions.furniture import Cuboid, Furniture, side_table
from inhand_lab.motions.grips import DRIFT_PERIOD, pinch
from inhand_lab.motions.idle_hand import idle_left_hand
from inhand_lab.motions.performance import Performance, Stance, feet_apart, hanging_hands
from inhand_lab.motions.reaching import PUT_BACK, TAKE, attention, carried_by, reaching_hand
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Move, Pause, Plan
from inhand_lab.objects.paint_brush import BRISTLES_BELOW, FERRULE_HALF_THICKNESS, paint_brush
from inhand_lab.people.person import SimulatedPerson

PLAN = Plan(
    opening=TAKE,
    use=(
        Move("wipe", 0.6),
        Move("apply", 0.65),
        Move("strokes", 2.7),
        Pause("look", 0.3),
        Move("over", 0.65),
        Move("dip", 0.45),
    ),
    closing=PUT_BACK,
)

HEADING = -0.45
"""Of the feet, a little to the board, radians."""
BOARD = 0.69
"""The board is this far at the right of somebody of usual height, metres."""
BOARD_SIZE = (0.03, 0.80, 2.0)
BOARD_COLOUR, POT_COLOUR, PAINT = (222, 216, 200), (150, 154, 160), (72, 120, 168)
POT_HALF_WIDTH, POT_HEIGHT, POT_WALL = 0.070, 0.09, 0.004

FURTHEST = 0.17
"""Ahead of the person, in statures."""
STROKES = (3, 5)
MIDDLE, HALF_STROKE = 0.73, 0.105
"""Height of the strokes' middle and half their length, in statures."""
ALONG_BOARD = (0.12, 0.17)
"""Where painting begins, ahead of the person; every stroke is a brush's width further on."""
PAINTING = np.radians((-72.0, 16.0))
"""Where the brush points to the board, to the left of ahead and up."""
TRAILING = np.radians(9.0)
"""The handle leads and the bristles trail by this."""
STANDING = np.array((-0.10, np.radians(-42.0)))
"""Where the brush points in the pot, its handle on the near edge."""
DIPPING = np.array((HEADING + 0.2, np.radians(-56.0)))
POINTING_AHEAD = np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]])
"""A brush whose bristles point ahead, in the person's world."""

ALONG_FINGERS = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""The brush's frame from a hand that lies along it, the palm on its flat side."""
TO_THUMB, TO_PALM = 0.20, 0.25
"""How far the bristles lean to thumb and palm of a usual hand, radians."""


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Painting at these times, in seconds from the start; the board is at the right."""
    script = write_script(person, times, random, PLAN)
    board = BOARD * script.size + random.normal(0.0, 0.015)
    path = _path(script)
    posture, trunk = script.stand(_stance(script, path))
    table, standing, pot = _table(script)
    carried = _carry(script, _on_board(path, board), standing, pot)
    held = carried @ _grip(script)
    right_rest, left_rest = hanging_hands(person, trunk, random)
    left_hand = idle_left_hand(script, trunk, left_rest)
    right_hand = reaching_hand(script, right_rest, held, bow=(0.05, -0.05, 0.10))
    furniture = (*table, _board(board))
    return Performance(
        posture, right_hand, left_hand, carried, carried_by(script), furniture, script.stages
    )


def _path(script: Script) -> Array:
    """The bristles on the board (T, 4): ahead and up, metres, and where they point, radians."""
    height, manner, random = script.person.height, script.person.manner, script.random
    usual = PAINTING + np.array([0.4 * manner.grip_tilt, 0.3 * manner.grip_turn])
    half = HALF_STROKE * height * min(manner.amplitude, 1.12)
    middle = MIDDLE * height + random.normal(0.0, 0.02)
    knots = []
    for stage in script.every("strokes"):
        count = int(random.integers(*STROKES, endpoint=True))
        bounds = np.linspace(stage.start, stage.end, count + 1)
        along, way = random.uniform(*ALONG_BOARD), 1.0
        knots.append((bounds[0], (along, middle + half, *usual)))
        for start, end in pairwise(bounds):
            reached = middle - way * half * random.uniform(0.85, 1.0)
            trailing = (usual[0], usual[1] + way * TRAILING)
            before = knots[-1][1]
            between = (along + 0.02, 0.5 * (before[1] + reached), *trailing)
            along = min(along + random.uniform(0.03, 0.05), FURTHEST * height)
            knots += [(0.5 * (start + end), between), (end, (along, reached, *usual))]
            way = -way
    path = script.flow(knots)
    path[:, 2:] += script.drifts(0.04, DRIFT_PERIOD, count=2)
    return path


def _stance(script: Script, path: Array) -> Stance:
    """Turned to the board, the eyes on the brush."""
    height, count = script.person.height, len(script.times)
    painting = np.sum([script.around(stage, 0.6, 0.8) for stage in script.every("strokes")], axis=0)
    looked = np.clip(attention(script), 0.0, 1.0)
    up = painting * (path[:, 1] / height - MIDDLE)
    trunk = np.stack([0.12 - 0.6 * up, 0.10 * painting, 0.20 - 0.45 * painting], axis=1)
    head = np.stack([-0.25 + 0.25 * painting + 1.2 * up, 0.0 * up, -0.50 * painting], axis=1)
    trunk += np.outer(looked, [0.25, 0.0, 0.10])
    head += np.outer(looked, [-0.15, 0.0, 0.15])
    shift = np.outer(painting, [0.03 * script.size, 0.0, 0.0])
    turned = rotation_about("z", HEADING)
    right_foot, left_foot = (foot @ turned.T for foot in feet_apart(script.person, count, 0.12))
    return Stance(right_foot, left_foot, np.full(count, HEADING), shift, trunk, head)


def _board(x: float) -> Cuboid:
    """The board, its near side at x, metres."""
    deep, _, high = BOARD_SIZE
    return Cuboid((x + 0.5 * deep, 0.10, 0.5 * high), BOARD_SIZE, BOARD_COLOUR)


def _table(script: Script) -> tuple[Furniture, Transform, Array]:
    """A table with a pot; the brush in it, world_from_object; the middle of the pot's floor (3,).

    The bristles are on the floor of the pot, the handle is on its near edge.
    """
    x, y = script.place(0.18, 0.56)
    top = script.table_top(0.43)
    pot = np.array([x, y - 0.08, top + 0.006])
    to_left, up = STANDING[0] + script.random.normal(0.0, 0.1), STANDING[1]
    rotation = _pointing(np.array([to_left]), np.array([up]))[0]
    place = -rotation @ [0.0, 0.0, -BRISTLES_BELOW]
    place[1] += POT_HEIGHT / np.tan(-up) - POT_HALF_WIDTH + 1.6 * FERRULE_HALF_THICKNESS
    standing = Transform(pot + place + [0.0, 0.0, 0.004], rotation)
    return (*side_table(x, y, top), *_pot(x, y - 0.08, top)), standing, pot


def _pot(x: float, y: float, top: float) -> list[Cuboid]:
    """Four walls, and paint on the floor."""
    wide, high, thick = POT_HALF_WIDTH, POT_HEIGHT, POT_WALL
    middle, across, along = top + 0.5 * high, (2.0 * wide, thick, high), (thick, 2.0 * wide, high)
    return [
        Cuboid((x - wide, y, middle), along, POT_COLOUR),
        Cuboid((x + wide, y, middle), along, POT_COLOUR),
        Cuboid((x, y - wide, middle), across, POT_COLOUR),
        Cuboid((x, y + wide, middle), across, POT_COLOUR),
        Cuboid((x, y, top + 0.003), (2.0 * wide, 2.0 * wide, 0.006), PAINT),
    ]


def _pointing(to_left: Array, up: Array) -> Array:
    """The brush's rotations (T, 3, 3) that point the bristles in those directions (T,), radians."""
    return rotation_about("xz", up, to_left) @ POINTING_AHEAD


def _on_board(path: Array, board: float) -> Transform:
    """The brush, world_from_object (T), with its bristles just on the board."""
    rotation = _pointing(path[:, 2], path[:, 3])
    tips = np.einsum("tij,j->ti", rotation, np.array([0.0, 0.0, -BRISTLES_BELOW]))
    across = np.einsum("tj,vj->tv", rotation[:, 0], paint_brush().vertices).max(axis=1)
    place = np.stack([board - 0.002 - across, path[:, 0] - tips[:, 1], path[:, 1] - tips[:, 2]], 1)
    return Transform(place, rotation)


def _grip(script: Script) -> Transform:
    """Fingers and thumb on the flat sides above the ferrule, object_from_hand (T)."""
    manner = script.person.manner
    leaning = TO_THUMB + manner.grip_tilt
    turned = rotation_about("zx", -TO_PALM + 0.5 * manner.grip_turn, leaning)
    point = np.array([0.0, 0.0, 0.030 + 0.015 * manner.grip_slide])
    return pinch(script, point, ALONG_FINGERS @ turned)


def _carry(script: Script, painting: Transform, standing: Transform, pot: Array) -> Transform:
    """The brush's way, world_from_object (T): from the pot to the board and back."""
    rotation = _pointing(DIPPING[:1], DIPPING[1:])[0]
    tips = rotation @ [0.0, 0.0, -BRISTLES_BELOW]
    leaned = np.array([*tips[:2], 0.0]) * 0.6

    def above(height: float) -> Transform:
        place = pot + height * np.array([0.0, 0.0, 1.0]) - tips + leaned
        return script.still(Transform(place, rotation))

    rest, over, dipped = script.still(standing), above(POT_HEIGHT + 0.05), above(0.015)
    goals = {
        "wipe": To(over, bow=(0.0, 0.01, 0.0)),
        "apply": To(painting, bow=(0.02, 0.10, 0.0)),
        "strokes": To(painting),
        "over": To(over, bow=(0.0, -0.03, 0.03)),
        "dip": To(dipped),
        "return": To(rest, bow=(0.0, 0.0, 0.04)),
    }
    return script.way(rest, goals)
