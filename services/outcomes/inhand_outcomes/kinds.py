"""The kinds of outcomes, and the amounts of each."""

from collections.abc import Iterable

from inhand_outcomes.handling import DROPPED, LEFT_IN_USE, PUT_DOWN, TAKEN_UP
from inhand_outcomes.uses import USES, Use
from inhand_outcomes.watching import HANDED_OVER

HANDLED = (TAKEN_UP, PUT_DOWN, DROPPED, HANDED_OVER, LEFT_IN_USE)
"""Kinds that there are of every object."""


def amounts_by_kind(uses: Iterable[Use] = USES.values()) -> dict[str, set[str]]:
    """Return the names of amounts of every kind that there is with some uses; what is taken up or
    put down has none."""
    kinds: dict[str, set[str]] = {kind: set() for kind in HANDLED}
    for use in uses:
        for kind, amounts in use.kinds.items():
            kinds.setdefault(kind, set()).update(amounts)
    return kinds
