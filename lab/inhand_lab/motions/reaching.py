"""One hand that takes a thing from its place, holds it and puts it back; the eyes go with it."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array, Bytes

from inhand_lab.geometry.transforms import Transform
from inhand_lab.motions.performance import ContactKind, contacts
from inhand_lab.motions.timeline import Key, Move, Pause, Stage, move_through, track

TAKE = (Pause("wait", 0.5), Move("reach", 1.0), Move("grasp", 0.25))
"""Stages until the thing leaves its place."""

PUT_BACK = (
    Move("return", 1.0),
    Move("release", 0.25),
    Move("withdraw", 1.0),
    Pause("wait", 0.5),
)
"""Stages from the way back to its place on."""

LINGER = 1.2
"""How long eyes and trunk take to turn away from what was reached for, seconds."""

FROM_ABOVE = np.array([-0.16, -0.08, 0.15])
"""Where a left hand comes from, over the edge of a table, to its place on it."""


def reaching_hand(
    times: Array,
    stages: list[Stage],
    rest: Transform,
    held: Transform,
    bow: tuple[float, float, float],
) -> Transform:
    """The hand, world_from_hand (T): at rest, on the thing from "reach" to "withdraw", at rest.

    bow is how far its way to the thing and back swings out, in metres.
    """
    reach, withdraw = named(stages, "reach"), named(stages, "withdraw")
    return move_through(
        times,
        [
            Key(reach.start, rest),
            Key(reach.end, held, bow=bow),
            Key(withdraw.start, held),
            Key(withdraw.end, rest, bow=bow),
        ],
    )


def helping_hand(times: Array, stages: list[Stage], rest: Transform, place: Transform) -> Transform:
    """The left hand, world_from_hand (T): at one place from "lift" to "return", else at rest."""
    lift, back = named(stages, "lift"), named(stages, "return")
    there = place.repeated(len(times))
    above = Transform(there.translation + FROM_ABOVE, there.rotation)
    return move_through(
        times,
        [
            Key(lift.start, rest),
            Key(lift.end, there, by=above),
            Key(back.start, there),
            Key(back.end, rest, by=above),
        ],
    )


def held_by_right_hand(times: Array, stages: list[Stage]) -> Bytes:
    """What carries the thing (T,): the right hand from the end of "grasp" to "release"."""
    changes = [
        (0.0, ContactKind.RESTING),
        (named(stages, "grasp").end, ContactKind.RIGHT_HAND),
        (named(stages, "release").start, ContactKind.RESTING),
    ]
    return contacts(times, changes)


def attention(times: Array, stages: list[Stage]) -> Array:
    """How much (T,), 0 to 1, somebody looks at the place from which they take the thing."""
    share = np.zeros(len(times))
    for name in ("reach", "return"):
        stage = named(stages, name)
        share += track(times, [(stage.start, 0.0), (stage.end, 1.0), (stage.end + LINGER, 0.0)])
    return share


def named(stages: list[Stage], name: str) -> Stage:
    """The first stage of that name."""
    return next(stage for stage in stages if stage.name == name)
