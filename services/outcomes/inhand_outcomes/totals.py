"""What was done in days: how often, for how long, and how much."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import date

from inhand_outcomes.achievement import Amount
from inhand_outcomes.outcome import adds_up


@dataclass(frozen=True)
class AmountTotal:
    """An amount of ``times`` outcomes: the sum, its variance, and the largest value."""

    times: int
    sum: float
    variance: float
    largest: float

    def __add__(self, other: "AmountTotal") -> "AmountTotal":
        return AmountTotal(
            self.times + other.times,
            self.sum + other.sum,
            self.variance + other.variance,
            max(self.largest, other.largest),
        )

    def amount(self, name: str) -> Amount:
        """Return the sum of what adds up, and the mean of what does not."""
        share = 1.0 if adds_up(name) else 1.0 / self.times
        return Amount(share * self.sum, share * self.variance**0.5)


@dataclass(frozen=True)
class DayTotal:
    """What one person, None for nobody, did of one kind with one object on a local day.

    Where ``counted`` is false it is what was too uncertain to count.
    """

    day: date
    kind: str
    object: str
    person: int | None
    counted: bool
    times: int
    seconds: float
    amounts: Mapping[str, AmountTotal] = field(default_factory=dict)


PLACE_ENDS = ("_x_m", "_y_m", "_z_m")
"""Ends of the names of amounts that are coordinates, whose sum and mean mean nothing."""


def has_total(name: str) -> bool:
    """Whether an amount of this name is part of totals: a place is not."""
    return not name.endswith(PLACE_ENDS)


def sum_of_amount(totals: Iterable[DayTotal], name: str) -> AmountTotal | None:
    """Put an amount of totals together; None where none has it."""
    found = [total.amounts[name] for total in totals if name in total.amounts]
    return None if not found else sum(found[1:], found[0])
