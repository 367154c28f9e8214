"""One hand that takes a thing from its place, holds it and puts it back; the eyes go with it."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array, Bytes

from inhand_lab.geometry.transforms import Transform
from inhand_lab.motions.performance import ContactKind, contacts
from inhand_lab.motions.script import Script, To
from inhand_lab.motions.timeline import Move, Pause

TAKE = (Pause("wait", 0.5), Move("reach", 1.0), Move("grasp", 0.25))
"""Stages until the thing leaves its place."""

PUT_BACK = (Move("return", 1.0), Move("release", 0.25), Move("withdraw", 1.0), Pause("wait", 0.5))
"""Stages from the way back to its place on."""

LINGER = 1.2
"""Seconds that eyes and trunk take to turn away from what was reached for."""

FROM_ABOVE = np.array([-0.16, -0.08, 0.15])
"""Where a left hand comes from, over the edge of a table, to its place on it, metres."""


def reaching_hand(
    script: Script, rest: Transform, held: Transform, bow: tuple[float, float, float]
) -> Transform:
    """The hand, world_from_hand (T): at rest, on the thing from "reach" to "withdraw", at rest.

    bow is how far its way to the thing and back swings out, in metres.
    """
    return script.way(rest, {"reach": To(held, bow), "withdraw": To(rest, bow)})


def helping_hand(script: Script, rest: Transform, place: Transform) -> Transform:
    """The left hand, world_from_hand (T): at one place from "lift" to "return", else at rest."""
    there = script.still(place)
    above = Transform(there.translation + FROM_ABOVE, there.rotation)
    return script.way(rest, {"lift": To(there, by=above), "return": To(rest, by=above)})


def carried_by(
    script: Script,
    *between: tuple[float, ContactKind],
    taken: ContactKind = ContactKind.RIGHT_HAND,
) -> Bytes:
    """What carries the thing (T,): what took it at the end of "grasp", until "release".

    between is what carries it from a time on, seconds, where it changes.
    """
    grasped, released = script.stage("grasp").end, script.stage("release").start
    resting = ContactKind.RESTING
    changes = [(0.0, resting), (grasped, taken), *between, (released, resting)]
    return contacts(script.times, changes)


def attention(script: Script, linger: float = LINGER) -> Array:
    """How much (T,), 0 to 1, somebody looks at the place from which they take the thing."""
    share = np.zeros(len(script.times))
    for stage in script.every("reach", "return"):
        keys = [(stage.start, 0.0), (stage.end, 1.0), (stage.end + linger, 0.0)]
        share += script.track(keys)
    return share
