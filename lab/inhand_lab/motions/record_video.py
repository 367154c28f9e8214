"""recordVideo: take a camera from a table, hold it up with both hands, film, pan, put it back."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, interpolate, rotation_about
from inhand_lab.motions.furniture import Furniture, side_table
from inhand_lab.motions.grips import hold_bar
from inhand_lab.motions.performance import (
    ContactKind,
    Performance,
    Stance,
    contacts,
    feet_apart,
    hanging_hands,
    heading_of,
    stand,
)
from inhand_lab.motions.reaching import PUT_BACK, TAKE, attention, named, reaching_hand
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
from inhand_lab.objects.camera import CAMERA_HEIGHT, GRIP_OFFSET
from inhand_lab.people.kinematics import Trunk, place_trunk
from inhand_lab.people.person import SimulatedPerson

OPENING = (*TAKE, Move("fetch", 1.0), Pause("ready", 0.3), Move("raise", 1.0))
USE = (Pause("film", 0.9), Move("pan", 1.1), Pause("film", 0.9), Move("pan", 1.1))
CLOSING = (Pause("film", 1.0), Move("lower", 1.0), Pause("ready", 0.3), *PUT_BACK)

INWARDS = np.radians(25.0)
"""Turn of the fingers around the camera's front."""
STEEP_AT_TABLE, STEEP_AT_FACE = np.radians(-22.0), np.radians(50.0)
"""Where the fingers point above the camera's axis: the hands shift their hold while lifting."""

BEFORE_FACE = np.array([0.0, 0.30, 0.030])
BEFORE_CHEST = np.array([0.03, 0.32, -0.19])
"""The camera from the middle of the head and from the shoulder centre, metres."""
USUAL_PAN = 0.50
"""To either side, radians."""


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Filming at these times, in seconds from the start."""
    stages = schedule(person, random, float(times[-1]), OPENING, USE, CLOSING)
    pan, tilt = _aim(person, times, random, stages)
    posture = stand(person, times, random, _stance(times, stages, pan, tilt))
    trunk = place_trunk(person, posture)
    table, spot = _table(person, random)
    carried = _carry(person, times, random, trunk, spot, stages, tilt)
    right_held = carried @ _grip(person, times, random, stages)
    left_held = carried @ _grip(person, times, random, stages).mirrored()
    right_rest, left_rest = hanging_hands(person, trunk, random)
    fetch, lower, back = (named(stages, name) for name in ("fetch", "lower", "return"))
    joining = fetch.start + 0.2 * (fetch.end - fetch.start)
    left_hand = move_through(
        times,
        [
            Key(joining, left_rest),
            Key(fetch.end, left_held, bow=(-0.08, 0.12, 0.0)),
            Key(lower.end, left_held),
            Key(back.end, left_rest, bow=(-0.08, 0.12, 0.0)),
        ],
    )
    changes = [
        (0.0, ContactKind.RESTING),
        (named(stages, "grasp").end, ContactKind.RIGHT_HAND),
        (fetch.end, ContactKind.BOTH_HANDS),
        (lower.end, ContactKind.RIGHT_HAND),
        (named(stages, "release").start, ContactKind.RESTING),
    ]
    return Performance(
        posture,
        reaching_hand(times, stages, right_rest, right_held, bow=(0.06, -0.10, 0.16)),
        left_hand,
        carried,
        contacts(times, changes),
        table,
    )


def _aim(
    person: SimulatedPerson, times: Array, random: np.random.Generator, stages: list[Stage]
) -> tuple[Array, Array]:
    """Where the camera is meant to look: its turn to the left and up (T,), radians."""
    lower = named(stages, "lower")
    side = random.choice([-1.0, 1.0])
    level = random.normal(-0.03, 0.05)
    pans, tilts = [(0.0, 0.0)], [(0.0, level)]
    for stage in stages:
        if stage.name == "pan":
            reach = person.manner.amplitude * USUAL_PAN * random.uniform(0.6, 1.1)
            pans += [(stage.start, pans[-1][1]), (stage.end, side * reach)]
            tilts += [(stage.start, tilts[-1][1]), (stage.end, level + random.normal(0.0, 0.06))]
            side = -side
    pans += [(lower.start, pans[-1][1]), (lower.end, 0.0)]
    tilts += [(lower.start, tilts[-1][1]), (lower.end, level)]
    return track(times, pans), track(times, tilts)


def _stance(times: Array, stages: list[Stage], pan: Array, tilt: Array) -> Stance:
    """A look at the table; the body turns with the camera, the weight goes with it."""
    count = len(times)
    looked = attention(times, stages)[:, None]
    raised = _raised(times, stages)
    trunk = looked * np.array([0.10, 0.03, -0.15])
    trunk[:, 2] += 0.75 * pan
    trunk[:, 0] -= 0.05 * raised
    head = looked * np.array([-0.28, 0.0, -0.35])
    head += np.stack([raised * (0.10 + 0.5 * tilt), np.zeros(count), 0.25 * pan], axis=1)
    shift = np.stack([-0.04 * pan, np.zeros(count), np.zeros(count)], axis=1)
    right_foot, left_foot = feet_apart(count, half_width=0.11)
    return Stance(right_foot, left_foot, np.zeros(count), shift, trunk, head)


def _raised(times: Array, stages: list[Stage]) -> Array:
    """How far (T,), 0 to 1, the camera is up before the face."""
    up, down = named(stages, "raise"), named(stages, "lower")
    return track(times, [(up.start, 0.0), (up.end, 1.0), (down.start, 1.0), (down.end, 0.0)])


def _table(person: SimulatedPerson, random: np.random.Generator) -> tuple[Furniture, Array]:
    """A small table at the right hand and the camera's place on it (3,)."""
    size = person.height / 1.75
    x, y = np.array([0.28, 0.34]) * size + random.normal(0.0, 0.015, 2)
    top = 0.525 * person.height + random.normal(0.0, 0.015)
    return side_table(x + 0.10, y + 0.10, top), np.array([x, y, top + CAMERA_HEIGHT / 2.0])


def _grip(
    person: SimulatedPerson, times: Array, random: np.random.Generator, stages: list[Stage]
) -> Transform:
    """The right hand about the camera's side, thumb behind, object_from_hand (T)."""
    steepness = {"fetch": 0.5, "raise": 1.0, "lower": 0.5, "return": 0.0}
    inwards = INWARDS + 0.4 * person.manner.grip_turn
    at_table, at_face = (
        hold_bar(
            person,
            times,
            random,
            np.array([GRIP_OFFSET, 0.0, up + 0.008 * person.manner.grip_slide]),
            rotation_about("zx", inwards, steep),
        )
        for up, steep in ((0.025, STEEP_AT_TABLE), (0.0, STEEP_AT_FACE))
    )
    keys = [(0.0, 0.0)]
    for stage in stages:
        if stage.name in steepness:
            keys += [(stage.start, keys[-1][1]), (stage.end, steepness[stage.name])]
    return interpolate(at_table, at_face, track(times, keys))


def _carry(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    trunk: Trunk,
    spot: Array,
    stages: list[Stage],
    tilt: Array,
) -> Transform:
    """The camera's way, world_from_object (T)."""
    on_table = Transform(spot, rotation_about("z", random.normal(-0.12, 0.12)))
    upright = rotation_about("z", heading_of(trunk.world_from_head))
    before_face = BEFORE_FACE * (1.0, person.manner.amplitude, 1.0) + random.normal(0.0, 0.02, 3)
    shake = np.stack([drift(times, random, 0.003, 1.5) for _ in range(3)], axis=1)
    unsteady = [drift(times, random, 0.02, 1.5) for _ in range(2)]
    aimed = rotation_about("xz", tilt + unsteady[0], unsteady[1])
    filming = Transform(
        trunk.world_from_head.translation + upright @ before_face + shake, upright @ aimed
    )
    square = rotation_about("z", heading_of(trunk.world_from_chest))

    def before_chest() -> Transform:
        place = square @ (BEFORE_CHEST + random.normal(0.0, 0.02, 3))
        tipped = rotation_about("xz", -0.30 + random.normal(0.0, 0.1), random.normal(0.0, 0.1))
        return Transform(trunk.world_from_chest.translation + place, square @ tipped)

    keys = [Key(0.0, on_table.repeated(len(times)))]
    ends = {"raise": filming, "return": keys[0].pose}
    for stage in stages:
        if stage.name in ("fetch", "raise", "lower", "return"):
            there = ends.get(stage.name) or before_chest()
            keys += [
                Key(stage.start, keys[-1].pose),
                Key(stage.end, there, bow=(0.0, 0.02, 0.03)),
            ]
    return move_through(times, keys)
