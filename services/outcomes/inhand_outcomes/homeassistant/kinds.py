"""The kinds of outcomes that there are of each use, so that Home Assistant knows them before the
first comes."""

from collections.abc import Mapping

from inhand_outcomes.outcome import adds_up

DURATION, VOLUME, AREA, STROKES = "duration_s", "volume_ml", "area_m2", "stroke_count"

KINDS: Mapping[str, Mapping[str, tuple[str, ...]]] = {
    "drinking": {"sip": (VOLUME,), "refill": (VOLUME,)},
    "pouring": {"pour": (VOLUME, DURATION), "refill": (VOLUME,)},
    "phoning": {"call": (DURATION,)},
    "filming": {"filming": (DURATION,)},
    "lifting": {"repetition": (DURATION,)},
    "playing": {"playing": (DURATION,)},
    "tennis": {"stroke": ()},
    "golf": {"swing": ()},
    "hammering": {"strike": ()},
    "painting": {"painting": (AREA, DURATION, STROKES)},
    "wearing": {"put_on": (), "taken_off": (), "worn": (DURATION,)},
    "shaking": {"shake": (STROKES, DURATION)},
    "reading": {"reading": (DURATION,)},
    "shoes": {"shoe_on": (), "shoe_off": ()},
    "sweeping": {"sweeping": (AREA, DURATION, STROKES)},
}
"""By use and kind the amounts that are shown; others come with the first outcome that has them."""


def is_shown(amount: str) -> bool:
    """Whether an amount has a total of its own: what adds up, of times the whole duration."""
    return amount == DURATION or (adds_up(amount) and not amount.endswith("_s"))
