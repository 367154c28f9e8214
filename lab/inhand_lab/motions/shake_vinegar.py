"""shakeVinegar: take a bottle from a table, shake it over a plate in bursts, put it back."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_about
from inhand_lab.motions.furniture import Cuboid, Furniture, side_table
from inhand_lab.motions.grips import hold_bar
from inhand_lab.motions.idle_hand import idle_left_hand
from inhand_lab.motions.performance import Performance, Stance, hanging_hands
from inhand_lab.motions.reaching import PUT_BACK, TAKE, attention, carried_by, reaching_hand
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Move, Pause, Plan, Stage
from inhand_lab.objects.vinegar_bottle import BOTTLE_HALF_HEIGHT, BOTTLE_RADIUS
from inhand_lab.people.person import SimulatedPerson

PLAN = Plan(
    opening=(*TAKE, Move("lift", 0.85)),
    use=(
        Move("tip", 0.55),
        Move("shake", 1.05, swift=True),
        Move("right", 0.45),
        Pause("look", 0.5),
    ),
    closing=PUT_BACK,
    on_stool=True,
)

IN_FIST = np.array([-0.015 - BOTTLE_RADIUS, 0.022, 0.0])
"""Where the bottle's axis passes through the hand."""

FINGERS_AT_TABLE, FINGERS_AT_PLATE = 0.15, 0.50
"""Where the fingers point, as turns to the left from straight ahead, radians."""

HELD_TILT, TIPPED = 0.55, 2.10
"""Tilt of the bottle to the left between bursts and while shaking, radians."""
SHAKES_A_SECOND = 3.5
SHAKE, SHAKE_TILT = 0.022, 0.13
"""A shake along the bottle, metres, and about the forearm, radians, to either side."""

PLATE_SIZE, PLATE_HEIGHT = 0.25, 0.018
CHINA, CHIPS = (232, 234, 238), (226, 178, 84)


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Shaking vinegar at these times, in seconds from the start."""
    script = write_script(person, times, random, PLAN)
    posture, trunk = script.stand(_stance(script))
    furniture, spot, plate = _table(script)
    carried = _carry(script, spot, plate)
    held = carried @ _grip(script)
    right_rest, left_rest = hanging_hands(person, trunk, random)
    right_hand = reaching_hand(script, right_rest, held, bow=(0.07, -0.05, 0.08))
    left_hand = idle_left_hand(script, trunk, left_rest)
    return Performance(
        posture, right_hand, left_hand, carried, carried_by(script), furniture, script.stages
    )


def _stance(script: Script) -> Stance:
    """A look at the bottle, and down at the plate while at work."""
    looked = attention(script)
    worked = script.level(0.0, {"lift": 1.0, "return": 0.0})
    trunk = np.outer(looked, [0.10, 0.03, -0.12]) + np.outer(worked, [0.10, -0.02, 0.05])
    head = np.outer(looked, [-0.30, 0.0, -0.25]) + np.outer(worked, [-0.40, 0.0, 0.08])
    return script.upright_stance(trunk, head)


def _table(script: Script) -> tuple[Furniture, Array, Array]:
    """A table ahead, the bottle's place on it (3,) and the middle of the plate (3,)."""
    top = script.table_top(0.53)
    spot = np.array([*script.place(0.27, 0.38), top + BOTTLE_HALF_HEIGHT])
    x, y = script.place(-0.07, 0.40)
    height, narrow = top + PLATE_HEIGHT, 0.68 * PLATE_SIZE
    served = (
        Cuboid((x, y, top + PLATE_HEIGHT / 2.0), (PLATE_SIZE, narrow, PLATE_HEIGHT), CHINA),
        Cuboid((x, y, top + PLATE_HEIGHT / 2.0), (narrow, PLATE_SIZE, PLATE_HEIGHT), CHINA),
        Cuboid((x, y, height + 0.010), (0.13, 0.11, 0.020), CHIPS),
    )
    table = side_table(0.10, 0.24 * script.size + 0.20, top, width=0.75)
    return (*table, *served, *script.seat), spot, np.array([x, y, height])


def _grip(script: Script) -> Transform:
    """A fist around the bottle, object_from_hand (T)."""
    manner = script.person.manner
    point = np.array([0.0, 0.0, -0.015 + 0.02 * manner.grip_slide])
    return hold_bar(script, point, rotation_about("z", manner.grip_turn), IN_FIST)


def _carry(script: Script, spot: Array, plate: Array) -> Transform:
    """The bottle's way, world_from_object (T): over the plate it points to the left and down."""
    manner, random = script.person.manner, script.random
    from_fingers = rotation_about("z", -manner.grip_turn)

    def on_table() -> Transform:
        place = spot + np.append(random.normal(0.0, 0.012, 2), 0.0)
        turned = rotation_about("z", FINGERS_AT_TABLE + random.normal(0.0, 0.1))
        return script.still(Transform(place, turned @ from_fingers))

    first, last = on_table(), on_table()
    tipped = _tilt(script)
    shaken = _shakes(script)
    nod = 0.10 + script.drift(0.04, 2.0)
    turn = FINGERS_AT_PLATE + random.normal(0.0, 0.1) + script.drift(0.06, 3.0)
    rotation = rotation_about("yxz", -tipped - SHAKE_TILT * shaken, -nod, turn) @ from_fingers
    over = 1.0 - (tipped - HELD_TILT) / (TIPPED - HELD_TILT)
    above = np.outer(0.13 * manner.amplitude + 0.10 * over, [0.0, 0.0, 1.0])
    aside = np.outer(0.02 + 0.05 * over, [1.0, 0.0, 0.0])
    sprinkler = plate + above + aside + script.drifts(0.018, 2.0) * [1.0, 1.0, 0.6]
    middle = sprinkler + rotation[:, :, 2] * (SHAKE * shaken - BOTTLE_HALF_HEIGHT)[:, None]
    goals = {
        "lift": To(Transform(middle, rotation), bow=(0.0, -0.02, 0.05)),
        "return": To(last, bow=(0.0, -0.02, 0.06)),
    }
    return script.way(first, goals)


def _tilt(script: Script) -> Array:
    """The bottle's tilt (T,) to the left without the shakes, radians."""
    own = TIPPED + 0.25 * (script.person.manner.amplitude - 1.0)

    def deepest(_: Stage) -> float:
        return own + 0.08 * float(script.random.normal())

    def held(_: Stage) -> float:
        return HELD_TILT + 0.12 * float(script.random.normal())

    return script.level(HELD_TILT, {"tip": deepest, "right": held})


def _shakes(script: Script) -> Array:
    """Where (T,) the bottle is in its shakes, -1 to 1 for a person of average amplitude."""
    manner = script.person.manner
    shaken = np.zeros(len(script.times))
    for stage in script.every("shake"):
        rate = SHAKES_A_SECOND * manner.tempo * float(np.exp(script.random.normal(0.0, 0.06)))
        swell = 0.2 * stage.seconds
        strength = script.around(stage.part(0.2, 0.8), swell, swell)
        shaken += strength * np.sin(2.0 * np.pi * rate * (script.times - stage.start))
    return manner.amplitude * shaken
