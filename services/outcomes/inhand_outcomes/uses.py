"""The uses of things: what is measured of each, and which interactions teach it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from inhand_outcomes.achievement import Achievement
from inhand_outcomes.measures.drinking import drinking, sip_volumes
from inhand_outcomes.measures.filming import filming
from inhand_outcomes.measures.hammering import hammering
from inhand_outcomes.measures.lifting import lifting
from inhand_outcomes.measures.painting import painting
from inhand_outcomes.measures.phoning import phoning
from inhand_outcomes.measures.playing import playing
from inhand_outcomes.measures.pouring import pour_volumes, pouring
from inhand_outcomes.measures.reading import reading
from inhand_outcomes.measures.shaking import shaking
from inhand_outcomes.measures.shoes import shoes
from inhand_outcomes.measures.sweeping import sweeping
from inhand_outcomes.measures.swinging import golf, tennis
from inhand_outcomes.measures.wearing import wearing
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track

Measure = Callable[[Track, Thing], list[Achievement]]
"""What a family's file has: it finds in a track what was achieved with a thing, in order of time.

It sees a window that moves on, again and again, so what it says of one act must not depend on where
the window begins or ends; an act that the window cuts is left out, but for lasting ones.
"""

Completion = Callable[[Sequence[Achievement], Sequence[Achievement]], list[Achievement]]
"""What earlier outcomes say of what a measure has found: how much was left in a vessel, say.

It takes the achievements that were found and the last settled one of each kind that the object had
in anybody's hands, times of the same origin; it gives those that were found, completed.
"""


@dataclass(frozen=True)
class Use:
    """What is measured of things that are used so, and the interaction that teaches the use."""

    measure: Measure
    interaction: str
    kinds: Mapping[str, tuple[str, ...]]
    """The kinds of its outcomes, each with its amounts."""
    complete: Completion | None = None
    in_hand: bool = True
    """Whether it takes a hand that holds the thing."""
    parts: tuple[str, ...] = ()
    """Names of the parts of a thing that it goes by."""


DURATION, VOLUME, AREA, STROKES = "duration_s", "volume_ml", "area_m2", "stroke_count"
SPEED, ANGLE = "speed_m_s", "angle_deg"
LIFTED = ("range_m", "up_s", "down_s", "tilt_deg", "difference_m")

USES: Mapping[str, Use] = {
    "golf": Use(golf, "hitGolfBall", {"swing": (SPEED, ANGLE)}, parts=("head",)),
    "hammering": Use(hammering, "hammerNail", {"strike": (SPEED, "rate_per_min")}, parts=("face",)),
    "lifting": Use(lifting, "liftWeights", {"repetition": (DURATION, *LIFTED)}),
    "painting": Use(
        painting, "paintWall", {"painting": (AREA, DURATION, STROKES)}, parts=("head",)
    ),
    "shaking": Use(shaking, "shakeVinegar", {"shake": (STROKES, DURATION, "rate_per_s")}),
    "sweeping": Use(
        sweeping, "sweepFloor", {"sweeping": (AREA, DURATION, STROKES)}, parts=("head",)
    ),
    "tennis": Use(tennis, "hitTennisBall", {"stroke": (SPEED, ANGLE)}, parts=("head",)),
    "drinking": Use(
        drinking,
        "drinkFromMug",
        {"sip": (VOLUME,), "refill": (VOLUME,)},
        sip_volumes,
        parts=("rim",),
    ),
    "pouring": Use(
        pouring,
        "pourCream",
        {"pour": (VOLUME, DURATION, ANGLE), "refill": (VOLUME,)},
        pour_volumes,
        parts=("spout",),
    ),
    "phoning": Use(phoning, "answerPhone", {"call": (DURATION,)}),
    "filming": Use(
        filming,
        "recordVideo",
        {"filming": (DURATION, "azimuth_deg", "elevation_deg")},
        parts=("lens",),
    ),
    "playing": Use(playing, "playFlute", {"playing": (DURATION,)}, parts=("mouth_hole",)),
    "wearing": Use(
        wearing,
        "putOnGlasses",
        {"put_on": (), "taken_off": (), "worn": (DURATION,)},
        in_hand=False,
        parts=("bridge",),
    ),
    "reading": Use(reading, "magnifyText", {"reading": (DURATION,)}, parts=("lens", "handle")),
    "shoes": Use(shoes, "putOnShoe", {"shoe_on": (), "shoe_off": ()}, in_hand=False),
}
"""The uses by name."""


def use_of(interaction: str) -> str | None:
    """Return the use that an interaction teaches, by its name in a dataset; None for another."""
    return next((name for name, use in USES.items() if use.interaction == interaction), None)
