"""magnifyText: take a magnifying glass from a book, read through it line by line, lay it back."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_about, rotation_from_axes
from inhand_lab.motions.furniture import Cuboid, Furniture, side_table
from inhand_lab.motions.grips import hold_bar
from inhand_lab.motions.performance import Performance, Stance, hanging_hands
from inhand_lab.motions.reaching import (
    PUT_BACK,
    TAKE,
    attention,
    carried_by,
    helping_hand,
    reaching_hand,
)
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Move, Pause, Plan
from inhand_lab.objects.magnifier import HANDLE_END, HANDLE_TOP, RIM_RADIUS
from inhand_lab.people.person import SimulatedPerson

PLAN = Plan(
    opening=(*TAKE, Move("lift", 1.0), Pause("focus", 0.4)),
    use=(Move("line", 1.5), Pause("study", 0.4), Move("next line", 0.8), Pause("focus", 0.3)),
    closing=PUT_BACK,
    on_stool=True,
)

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
    script = write_script(person, times, random, PLAN)
    lens = _read(script)
    posture, trunk = script.stand(_stance(script, lens))
    furniture, page = _desk(script)
    carried = _carry(script, page, lens)
    held = carried @ _grip(script)
    right_rest, left_rest = hanging_hands(person, trunk, random)
    right_hand = reaching_hand(script, right_rest, held, bow=(0.06, -0.06, 0.16))
    left_hand = _hold_page(script, left_rest, page)
    return Performance(
        posture, right_hand, left_hand, carried, carried_by(script), furniture, script.stages
    )


def _read(script: Script) -> Array:
    """The lens (T, 3) from the middle of the page: along a line, up the page and above it."""
    random = script.random

    def height() -> float:
        return float(random.uniform(NEAREST, FURTHEST)) * script.person.manner.amplitude

    begin, end = LINE_ENDS
    place = np.array([begin, 0.3 * PRINTED_LINES * LINE_SPACING, height()])
    keys = [(0.0, place)]
    for stage in script.every("line", "next line"):
        if stage.name == "line":
            there = np.array([end, place[1], 0.5 * (place[2] + height())])
        else:
            down = LINE_SPACING * float(random.integers(1, 3))
            there = np.array([begin, place[1] - down, height()])
        there[0] += random.normal(0.0, 0.01)
        keys += [(stage.start, place), (stage.end, there)]
        place = there
    return script.track(keys)


def _stance(script: Script, lens: Array) -> Stance:
    """A look at the glass; bent over the page while reading, the head with the line."""
    looked = attention(script)
    lift, back = script.stage("lift"), script.stage("return")
    bounds = (lift.start - 0.5, lift.end, back.start, back.end + 0.3)
    bent = script.track(list(zip(bounds, (0.0, 1.0, 1.0, 0.0), strict=True)))
    trunk = np.outer(looked, [0.08, 0.02, -0.08])
    trunk[:, 0] += bent * (0.26 - 0.8 * (lens[:, 2] - FURTHEST))
    head = np.outer(looked, [-0.20, 0.0, -0.25])
    head += np.stack([-0.45 * bent, 0.0 * bent, -bent * (0.12 + 0.9 * lens[:, 0])], axis=1)
    return script.upright_stance(trunk, head)


def _desk(script: Script) -> tuple[Furniture, Array]:
    """A high table with an open book at its right edge, and the middle of its pages (3,)."""
    random, stout = script.random, script.person.girth - 1.0
    ahead = 0.45 * script.size + 0.15 * stout + random.normal(0.0, 0.015)
    across = random.normal(0.09, 0.015)
    top = script.table_top(0.56)
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
    return (*table, book, *lines, *script.seat), page


def _carry(script: Script, page: Array, lens: Array) -> Transform:
    """The glass's way, world_from_object (T): its handle overhangs the book where it lies."""
    random = script.random

    def flat() -> Array:
        right = HANDLE_TO_RIGHT + random.normal(0.0, 0.08)
        return rotation_from_axes([0.0, 0.0, 1.0], [-np.sin(right), np.cos(right), 0.0])

    edge = np.array([BOOK_SIZE[0] / 2.0 - 0.035, random.normal(-0.02, 0.015), RIM_RADIUS])
    lying = script.still(Transform(page + edge, flat()))
    tilt = TOWARDS_EYES + script.drift(0.06, 3.0)
    place = page + lens + script.drifts(0.004, 2.0)
    reading = Transform(place, rotation_about("x", tilt) @ flat())
    goals = {
        "lift": To(reading, bow=(0.0, 0.0, 0.02)),
        "return": To(lying, bow=(0.0, 0.0, 0.03)),
    }
    return script.way(lying, goals)


def _grip(script: Script) -> Transform:
    """A fist around the handle, object_from_hand (T)."""
    manner = script.person.manner
    along = 0.5 * (HANDLE_TOP + HANDLE_END) + 0.012 * manner.grip_slide
    square = rotation_about("z", FIST_TURN + manner.grip_turn)
    return hold_bar(script, np.array([0.0, 0.0, along]), square)


def _hold_page(script: Script, rest: Transform, page: Array) -> Transform:
    """The left hand, world_from_hand (T), flat on the book while reading."""
    own = script.random.normal(0.0, (0.015, 0.015, 0.002))
    palm = page + np.array([-0.175, -0.02, 0.055]) + own
    rotation = rotation_from_axes([0.35, 0.90, -0.12], [0.9, -0.35, 0.10])
    return helping_hand(script, rest, Transform(palm, rotation))
