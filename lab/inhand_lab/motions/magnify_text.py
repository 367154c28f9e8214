"""magnifyText: take a magnifying glass from a book, read through it line by line, lay it back."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_about, rotation_from_axes
from inhand_lab.motions.furniture import Cuboid, Furniture, side_table
from inhand_lab.motions.grips import hold_bar
from inhand_lab.motions.performance import Performance, Stance, feet_apart, hanging_hands, stand
from inhand_lab.motions.reaching import (
    PUT_BACK,
    TAKE,
    attention,
    held_by_right_hand,
    helping_hand,
    named,
    reaching_hand,
)
from inhand_lab.motions.timeline import (
    Key,
    Move,
    Pause,
    Stage,
    drift,
    move_through,
    schedule,
    track,
)
from inhand_lab.objects.magnifier import HANDLE_END, HANDLE_TOP, RIM_RADIUS
from inhand_lab.people.kinematics import place_trunk
from inhand_lab.people.person import SimulatedPerson

OPENING = (*TAKE, Move("lift", 1.0), Pause("focus", 0.4))
USE = (Move("line", 1.5), Pause("study", 0.4), Move("next line", 0.8), Pause("focus", 0.3))

FIST_TURN = np.radians(90.0)
"""Turn of the fist about the handle in the glass's frame: the palm is away from the eyes."""
HANDLE_TO_RIGHT = 1.25
"""The handle's turn to the right from pointing at the reader, radians."""
TOWARDS_EYES = 0.42
"""Tilt of the glass from the page to the reader, radians."""
NEAREST, FURTHEST = 0.07, 0.15
"""Of the lens above the page, metres: people move it until they see best."""

BOOK_SIZE = np.array([0.30, 0.22, 0.030])
PAGE_COLOUR, INK = (232, 228, 214), (96, 92, 88)
PRINTED_LINES = 8
LINE_SPACING = 0.022
LINE_ENDS = (-0.085, 0.085)
"""Where lines begin and end from the middle of the book."""


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Reading at these times, in seconds from the start."""
    stages = schedule(person, random, float(times[-1]), OPENING, USE, PUT_BACK)
    lens = _read(person, times, random, stages)
    posture = stand(person, times, random, _stance(times, stages, lens))
    trunk = place_trunk(person, posture)
    furniture, page = _desk(person, random)
    carried = _carry(times, random, page, lens, stages)
    square = rotation_about("z", FIST_TURN + person.manner.grip_turn)
    along = 0.5 * (HANDLE_TOP + HANDLE_END) + 0.012 * person.manner.grip_slide
    grip = hold_bar(person, times, random, np.array([0.0, 0.0, along]), square)
    right_rest, left_rest = hanging_hands(person, trunk, random)
    return Performance(
        posture,
        reaching_hand(times, stages, right_rest, carried @ grip, bow=(0.06, -0.06, 0.16)),
        _hold_page(times, random, left_rest, page, stages),
        carried,
        held_by_right_hand(times, stages),
        furniture,
    )


def _read(
    person: SimulatedPerson, times: Array, random: np.random.Generator, stages: list[Stage]
) -> Array:
    """The lens (T, 3) from the middle of the page: along a line, up the page and above it."""

    def height() -> float:
        return float(random.uniform(NEAREST, FURTHEST)) * person.manner.amplitude

    begin, end = LINE_ENDS
    place = np.array([begin, 0.3 * PRINTED_LINES * LINE_SPACING, height()])
    keys = [(0.0, place)]
    for stage in stages:
        if stage.name == "line":
            there = np.array([end, place[1], 0.5 * (place[2] + height())])
        elif stage.name == "next line":
            down = LINE_SPACING * float(random.integers(1, 3))
            there = np.array([begin, place[1] - down, height()])
        else:
            continue
        there[0] += random.normal(0.0, 0.01)
        keys += [(stage.start, place), (stage.end, there)]
        place = there
    return np.stack(
        [track(times, [(time, float(at[axis])) for time, at in keys]) for axis in range(3)], axis=1
    )


def _stance(times: Array, stages: list[Stage], lens: Array) -> Stance:
    """A look at the glass; bent over the page while reading, the head with the line."""
    count = len(times)
    looked = attention(times, stages)[:, None]
    lift, back = named(stages, "lift"), named(stages, "return")
    keys = [(lift.start - 0.5, 0.0), (lift.end, 1.0), (back.start, 1.0), (back.end + 0.3, 0.0)]
    bent = track(times, keys)
    trunk = looked * np.array([0.08, 0.02, -0.08])
    trunk[:, 0] += bent * (0.26 - 0.8 * (lens[:, 2] - FURTHEST))
    head = looked * np.array([-0.20, 0.0, -0.25])
    head += np.stack([-0.45 * bent, np.zeros(count), -bent * (0.12 + 0.9 * lens[:, 0])], axis=1)
    right_foot, left_foot = feet_apart(count)
    return Stance(right_foot, left_foot, np.zeros(count), np.zeros((count, 3)), trunk, head)


def _desk(person: SimulatedPerson, random: np.random.Generator) -> tuple[Furniture, Array]:
    """A high table with an open book at its right edge, and the middle of its pages (3,)."""
    ahead = 0.45 * person.height / 1.75 + 0.15 * (person.girth - 1.0) + random.normal(0.0, 0.015)
    across = random.normal(0.09, 0.015)
    top = 0.56 * person.height + random.normal(0.0, 0.015)
    width, depth, height = BOOK_SIZE
    page = np.array([across, ahead, top + height])
    book = Cuboid((across, ahead, top + height / 2.0), (width, depth, height), PAGE_COLOUR)
    begin, end = LINE_ENDS
    lines = [
        Cuboid(
            (across + 0.5 * (begin + end), ahead + (row - 3.5) * LINE_SPACING, page[2]),
            (end - begin, 0.3 * LINE_SPACING, 0.001),
            INK,
        )
        for row in range(PRINTED_LINES)
    ]
    table = side_table(across + width / 2.0 - 0.19, ahead + 0.07, top)
    return (*table, book, *lines), page


def _carry(
    times: Array, random: np.random.Generator, page: Array, lens: Array, stages: list[Stage]
) -> Transform:
    """The glass's way, world_from_object (T): its handle overhangs the book where it lies."""

    def flat() -> Array:
        right = HANDLE_TO_RIGHT + random.normal(0.0, 0.08)
        return rotation_from_axes([0.0, 0.0, 1.0], [-np.sin(right), np.cos(right), 0.0])

    edge = np.array([BOOK_SIZE[0] / 2.0 - 0.035, random.normal(-0.02, 0.015), RIM_RADIUS])
    lying = Transform(page + edge, flat()).repeated(len(times))
    tilt = TOWARDS_EYES + drift(times, random, 0.06, 3.0)
    wander = np.stack([drift(times, random, 0.004, 2.0) for _ in range(3)], axis=1)
    reading = Transform(page + lens + wander, rotation_about("x", tilt) @ flat())
    lift, back = named(stages, "lift"), named(stages, "return")
    return move_through(
        times,
        [
            Key(lift.start, lying),
            Key(lift.end, reading, bow=(0.0, 0.0, 0.02)),
            Key(back.start, reading),
            Key(back.end, lying, bow=(0.0, 0.0, 0.03)),
        ],
    )


def _hold_page(
    times: Array,
    random: np.random.Generator,
    rest: Transform,
    page: Array,
    stages: list[Stage],
) -> Transform:
    """The left hand, world_from_hand (T), flat on the book while reading."""
    palm = page + np.array([-0.175, -0.02, 0.055]) + random.normal(0.0, (0.015, 0.015, 0.002))
    rotation = rotation_from_axes([0.35, 0.90, -0.12], [0.9, -0.35, 0.10])
    return helping_hand(times, stages, rest, Transform(palm, rotation))
