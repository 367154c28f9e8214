"""The uses of things: what is measured of each, and which interactions teach it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from inhand_outcomes.achievement import Achievement
from inhand_outcomes.measures.hammering import hammering
from inhand_outcomes.measures.lifting import lifting
from inhand_outcomes.measures.painting import painting
from inhand_outcomes.measures.shaking import shaking
from inhand_outcomes.measures.sweeping import sweeping
from inhand_outcomes.measures.swinging import golf, tennis
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track

Measure = Callable[[Track, Thing], list[Achievement]]
"""What a family's file has: it finds in a track what was achieved with a thing, in order of time.

It sees a window that moves on, again and again, so what it says of one act must not depend on where
the window begins or ends; an act that the window cuts is left out, but for lasting ones.
"""


@dataclass(frozen=True)
class Use:
    """What is measured of things that are used so, and the interaction that teaches the use."""

    measure: Measure
    interaction: str


USES: Mapping[str, Use] = {
    "golf": Use(golf, "hitGolfBall"),
    "hammering": Use(hammering, "hammerNail"),
    "lifting": Use(lifting, "liftWeights"),
    "painting": Use(painting, "paintWall"),
    "shaking": Use(shaking, "shakeVinegar"),
    "sweeping": Use(sweeping, "sweepFloor"),
    "tennis": Use(tennis, "hitTennisBall"),
}
"""The uses by name."""


def use_of(interaction: str) -> str | None:
    """Return the use that an interaction teaches, by its name in a dataset; None for another."""
    return next((name for name, use in USES.items() if use.interaction == interaction), None)
