"""What is kept and published of an achievement: whose, with what, when, and the evidence."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, replace

from inhand_schemas.messages import Event, Pose

from inhand_outcomes.achievement import Amount

ADDED_UNITS = ("_s", "_ml", "_m2", "_count")
"""Ends of the names of amounts that add up; of others the mean over time is taken."""
RATE_UNITS = ("_m_s", "_deg_s", "_rad_s", "_per_s")
"""Ends of the names of speeds and rates, which are no seconds."""


@dataclass(frozen=True)
class Outcome:
    """One settled event.

    ``person`` is the number that a skeleton tracker gave them, None for nobody. ``rig_from_object``
    is where the object was at the end.
    """

    id: str
    kind: str
    object: str
    person: int | None
    start_ns: int
    end_ns: int
    probability: float
    amounts: Mapping[str, Amount]
    evidence: Mapping[str, float]
    rig_from_object: Pose | None = None
    first_sequence: int | None = None
    last_sequence: int | None = None

    @property
    def seconds(self) -> float:
        """How long it lasted."""
        return (self.end_ns - self.start_ns) * 1e-9

    def with_more(self, later: "Outcome") -> "Outcome":
        """This one, going on as the later one: amounts add up, or are means over time."""
        share = later.seconds / max(self.seconds + later.seconds, 1e-9)
        amounts = dict(self.amounts)
        for name, more in later.amounts.items():
            here = amounts.get(name)
            amounts[name] = more if here is None else _together(name, here, more, share)
        return replace(
            self,
            end_ns=later.end_ns,
            probability=max(self.probability, later.probability),
            amounts=amounts,
            evidence={**self.evidence, **later.evidence},
            rig_from_object=later.rig_from_object,
            last_sequence=later.last_sequence,
        )

    def message(self, sequence: int) -> Event:
        """The event as it is published."""
        return Event(
            sequence=sequence,
            time_ns=self.end_ns,
            kind=self.kind,
            object=self.object,
            person=self.person,
            duration_ns=self.end_ns - self.start_ns,
            evidence=dict(self.evidence),
            id=self.id,
            probability=self.probability,
            amounts={name: amount.value for name, amount in self.amounts.items()},
            deviations={name: amount.deviation for name, amount in self.amounts.items()},
            rig_from_object=self.rig_from_object,
            first_sequence=self.first_sequence,
            last_sequence=self.last_sequence,
        )


def adds_up(name: str) -> bool:
    """Whether an amount of this name is summed, as litres are and angles and speeds are not."""
    return name.endswith(ADDED_UNITS) and not name.endswith(RATE_UNITS)


def outcome_id(place: str, kind: str, object_name: str, person: int | None, start_ns: int) -> str:
    """Return the id of an event: the same whenever the same act is found again."""
    text = f"{place}/{kind}/{object_name}/{person}/{start_ns}"
    return hashlib.blake2b(text.encode(), digest_size=12).hexdigest()


def _together(name: str, first: Amount, second: Amount, share: float) -> Amount:
    if adds_up(name):
        deviation = (first.deviation**2 + second.deviation**2) ** 0.5
        return Amount(first.value + second.value, deviation)
    value = (1.0 - share) * first.value + share * second.value
    deviations = ((1.0 - share) * first.deviation, share * second.deviation)
    return Amount(value, (deviations[0] ** 2 + deviations[1] ** 2) ** 0.5)
