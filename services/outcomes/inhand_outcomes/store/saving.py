"""Adds what is settled, each act once, with the day's totals and the daemon's journal."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date
from typing import Literal
from zoneinfo import ZoneInfo

from inhand_schemas.messages import Pose
from sqlalchemy import delete, func, or_, select
from sqlalchemy.orm import Session

from inhand_outcomes.achievement import Amount
from inhand_outcomes.days import NS_PER_S, local_day
from inhand_outcomes.outcome import Outcome
from inhand_outcomes.store.database import Database
from inhand_outcomes.store.models import (
    NOBODY,
    AmountRow,
    ForgottenRow,
    JournalRow,
    OutcomeRow,
    PlaceRow,
    TotalAmountRow,
    TotalRow,
)

Kept = Literal["numbers", "poses"]
DIGITS = 6
"""Number of digits of evidence and poses that are kept: micrometres of a metre."""

LATE_S = 3600.0
"""Seconds by which outcomes of one object come out of order at most."""


@dataclass(frozen=True)
class Keeping:
    """How outcomes are kept: by days of a zone, counted from the probability ``sure`` on, with
    the kinds of evidence ``keep``."""

    zone: ZoneInfo
    sure: float = 0.5
    keep: frozenset[Kept] = frozenset({"numbers", "poses"})


@dataclass(frozen=True)
class Saved:
    """What became of outcomes: those that are new, those that the store had already, and those
    that somebody had forgotten before they came."""

    added: Sequence[Outcome] = ()
    known: Sequence[Outcome] = ()
    forgotten: Sequence[Outcome] = ()
    forget: bool = False
    """Whether something was forgotten since the last time: the journal was not kept, and who
    keeps it must begin anew with nothing in memory."""


@dataclass
class Saver:
    """Adds to a database for one daemon, which learns by it what was forgotten meanwhile."""

    database: Database
    keeping: Keeping
    _heard: int = field(init=False)

    def __post_init__(self) -> None:
        with self.database.reading() as session:
            self._heard = _newest_forgotten(session)

    def save(
        self, outcomes: Iterable[Outcome], journal: Mapping[str, bytes | None] | None = None
    ) -> Saved:
        """Add outcomes, and replace entries of the journal (None removes one): all or nothing.

        An outcome is known where its id is, or where one of the same object, kind and person
        overlaps it: it changes nothing then. Raises StoreError.
        """
        outcomes = list(outcomes)
        with self.database.writing(durable=bool(outcomes)) as session:
            heard = _newest_forgotten(session)
            forgotten = list(
                session.scalars(select(ForgottenRow).where(ForgottenRow.number > self._heard))
            )
            added, known, refused = [], [], []
            for outcome in outcomes:
                day = local_day(outcome.end_ns, self.keeping.zone)
                if any(_was_forgotten(outcome, day, row) for row in forgotten):
                    refused.append(outcome)
                elif _is_known(session, outcome):
                    known.append(outcome)
                else:
                    _add(session, outcome, day, self.keeping)
                    added.append(outcome)
            if not forgotten:
                _write_journal(session, journal or {})
        self._heard = heard
        return Saved(added, known, refused, bool(forgotten))


def read_journal(database: Database) -> dict[str, bytes]:
    """Return the daemon's journal; raises StoreError."""
    with database.reading() as session:
        return {row.name: row.value for row in session.scalars(select(JournalRow))}


def _write_journal(session: Session, journal: Mapping[str, bytes | None]) -> None:
    for name, value in journal.items():
        if value is None:
            session.execute(delete(JournalRow).where(JournalRow.name == name))
        else:
            session.merge(JournalRow(name=name, value=value))


def _newest_forgotten(session: Session) -> int:
    return session.scalar(select(func.max(ForgottenRow.number))) or 0


def _was_forgotten(outcome: Outcome, day: date, row: ForgottenRow) -> bool:
    return (
        outcome.end_ns <= row.time_ns
        and row.person in (None, outcome.person)
        and row.day in (None, day)
    )


def _is_known(session: Session, outcome: Outcome) -> bool:
    row = OutcomeRow
    same_act = (
        (row.object == outcome.object)
        & (row.kind == outcome.kind)
        & (row.person == number_of(outcome.person))
        & (row.end_ns > outcome.start_ns)
        & (row.start_ns < outcome.end_ns)
    )
    return (
        session.scalar(select(row.id).where(or_(row.id == outcome.id, same_act)).limit(1))
        is not None
    )


def _add(session: Session, outcome: Outcome, day: date, keeping: Keeping) -> None:
    amounts = {
        name: amount
        for name, amount in outcome.amounts.items()
        if math.isfinite(amount.value) and math.isfinite(amount.deviation)
    }
    counted = outcome.probability >= keeping.sure
    session.add(_row(outcome, amounts, day, counted=counted, keep=keeping.keep))
    session.flush()
    key = (day, outcome.kind, outcome.object, number_of(outcome.person), counted)
    total = session.get(TotalRow, key) or _new_total(session, key)
    total.times += 1
    total.seconds += outcome.seconds
    for name, amount in amounts.items():
        of_amount = session.get(TotalAmountRow, (*key, name)) or _new_amount(session, key, name)
        of_amount.times += 1
        of_amount.sum += amount.value
        of_amount.variance += amount.deviation**2
        of_amount.largest = max(of_amount.largest, amount.value)
    if counted and outcome.rig_from_object is not None and "poses" in keeping.keep:
        _take_place(session, outcome, day)


Key = tuple[date, str, str, int, bool]


def _new_total(session: Session, key: Key) -> TotalRow:
    day, kind, object_name, person, counted = key
    row = TotalRow(
        day=day,
        kind=kind,
        object=object_name,
        person=person,
        counted=counted,
        times=0,
        seconds=0.0,
    )
    session.add(row)
    return row


def _new_amount(session: Session, key: Key, name: str) -> TotalAmountRow:
    day, kind, object_name, person, counted = key
    row = TotalAmountRow(
        day=day,
        kind=kind,
        object=object_name,
        person=person,
        counted=counted,
        name=name,
        times=0,
        sum=0.0,
        variance=0.0,
        largest=-math.inf,
    )
    session.add(row)
    return row


def _take_place(session: Session, outcome: Outcome, day: date) -> None:
    pose = _pose_numbers(outcome.rig_from_object)
    place = session.get(PlaceRow, outcome.object)
    later_s = 0.0 if place is None else (place.time_ns - outcome.end_ns) / NS_PER_S
    # What is later by far was said by a clock that was wrong.
    if pose is not None and not 0.0 < later_s < LATE_S:
        session.merge(
            PlaceRow(
                object=outcome.object,
                time_ns=outcome.end_ns,
                day=day,
                kind=outcome.kind,
                person=number_of(outcome.person),
                pose=pose,
            )
        )


def _row(
    outcome: Outcome,
    amounts: Mapping[str, Amount],
    day: date,
    *,
    counted: bool,
    keep: frozenset[Kept],
) -> OutcomeRow:
    evidence = {name: _short(value) for name, value in outcome.evidence.items()}
    return OutcomeRow(
        id=outcome.id,
        kind=outcome.kind,
        object=outcome.object,
        person=number_of(outcome.person),
        start_ns=outcome.start_ns,
        end_ns=outcome.end_ns,
        day=day,
        probability=outcome.probability,
        counted=counted,
        pose=_pose_numbers(outcome.rig_from_object) if "poses" in keep else None,
        evidence=evidence if evidence and "numbers" in keep else None,
        first_sequence=outcome.first_sequence,
        last_sequence=outcome.last_sequence,
        amounts=[
            AmountRow(name=name, value=amount.value, deviation=amount.deviation)
            for name, amount in amounts.items()
        ],
    )


def number_of(person: int | None) -> int:
    """Return the number of a person in the tables."""
    return NOBODY if person is None else person


def person_of(number: int) -> int | None:
    """Return the person of a number in the tables, None for nobody."""
    return None if number == NOBODY else number


def _pose_numbers(pose: Pose | None) -> list[float] | None:
    if pose is None:
        return None
    return [float(f"{number:.{DIGITS}g}") for number in (*pose.translation, *pose.rotation)]


def _short(value: float) -> float | None:
    """A number with fewer digits; JSON has none that is not finite."""
    return float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None
