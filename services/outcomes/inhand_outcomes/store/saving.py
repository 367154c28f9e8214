"""Adds what is settled, each act once, with the day's totals and the daemon's journal."""

import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date
from time import time_ns
from typing import Any, Literal
from zoneinfo import ZoneInfo

from inhand_schemas.messages import Pose
from sqlalchemy import delete, func, or_, select, update
from sqlalchemy.orm import Session

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
from inhand_outcomes.totals import has_total

Kept = Literal["numbers", "poses"]
DIGITS = 6
"""Number of digits of evidence and poses that are kept: micrometres of a metre."""

STANDING = "standing/"
"""Beginning of the names of a journal's entries that are no memory of what was seen, and stay when
something is forgotten."""
AHEAD_S = 60.0
"""Seconds by which the clock of a camera is ahead of this machine's at most."""


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
    clock: Callable[[], int] = time_ns
    """The time of now, in nanoseconds since the epoch."""
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
            added, known, refused, rows = [], [], [], []
            for outcome in outcomes:
                day = local_day(outcome.end_ns, self.keeping.zone)
                if any(_was_forgotten(outcome, day, row) for row in forgotten):
                    refused.append(outcome)
                elif _is_known(session, outcome):
                    known.append(outcome)
                else:
                    row = _row(outcome, day, self.keeping)
                    session.add(row)
                    rows.append(row)
                    added.append(outcome)
            _add_to_totals(session, rows)
            _take_places(session, rows, self.clock())
            if not forgotten:
                _write_journal(session, journal or {})
        self._heard = heard
        return Saved(added, known, refused, bool(forgotten))


def mark_outcomes_published(database: Database, ids: Iterable[str]) -> None:
    """Take note that the events of outcomes went out; raises StoreError."""
    with database.writing() as session:
        went_out = update(OutcomeRow).where(OutcomeRow.id.in_(list(ids)))
        session.execute(went_out.values(published=True))


def read_journal(database: Database) -> dict[str, bytes]:
    """Return the daemon's journal; raises StoreError."""
    with database.reading() as session:
        return {row.name: row.value for row in session.scalars(select(JournalRow))}


def write_journal(database: Database, journal: Mapping[str, bytes | None]) -> None:
    """Replace entries of the journal, None removes one; raises StoreError."""
    with database.writing() as session:
        _write_journal(session, journal)


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


def _add_to_totals(session: Session, rows: Sequence[OutcomeRow]) -> None:
    by_key: dict[Key, list[OutcomeRow]] = defaultdict(list)
    for row in rows:
        by_key[row.day, row.kind, row.object, row.person, row.counted].append(row)
    for key, group in by_key.items():
        total = session.get(TotalRow, key) or _new_total(session, key)
        total.times += len(group)
        total.seconds += sum((row.end_ns - row.start_ns) / NS_PER_S for row in group)
        amounts: dict[str, list[AmountRow]] = defaultdict(list)
        for row in group:
            for amount in row.amounts:
                if has_total(amount.name):
                    amounts[amount.name].append(amount)
        for name, found in amounts.items():
            of_amount = session.get(TotalAmountRow, (*key, name)) or _new_amount(session, key, name)
            of_amount.times += len(found)
            of_amount.sum += sum(one.value for one in found)
            of_amount.variance += sum(one.deviation**2 for one in found)
            of_amount.largest = max(of_amount.largest, *(one.value for one in found))


Key = tuple[date, str, str, int, bool]
"""Day, kind, object, person, and whether it counts."""


def _new_total(session: Session, key: Key) -> TotalRow:
    row = TotalRow(**_of_key(key), times=0, seconds=0.0)
    session.add(row)
    return row


def _new_amount(session: Session, key: Key, name: str) -> TotalAmountRow:
    start = {"times": 0, "sum": 0.0, "variance": 0.0, "largest": -math.inf}
    row = TotalAmountRow(**_of_key(key), name=name, **start)
    session.add(row)
    return row


def _of_key(key: Key) -> dict[str, Any]:
    return dict(zip(("day", "kind", "object", "person", "counted"), key, strict=True))


def _take_places(session: Session, rows: Sequence[OutcomeRow], now_ns: int) -> None:
    """Take note of where things were seen last.

    What is said to be yet to come, by a clock that was wrong, gives way to all that comes after it.
    """
    to_come_ns = now_ns + round(AHEAD_S * NS_PER_S)
    places: dict[str, PlaceRow | None] = {}
    for row in rows:
        if row.object not in places:
            places[row.object] = session.get(PlaceRow, row.object)
        place = places[row.object]
        later = place is not None and row.end_ns < place.time_ns <= to_come_ns
        if row.counted and row.pose is not None and not later:
            places[row.object] = place_of(row, row.pose)
    for place in places.values():
        if place is not None:
            session.merge(place)


def place_of(row: OutcomeRow, pose: list[float]) -> PlaceRow:
    """Return where an outcome says that its object was."""
    return PlaceRow(
        object=row.object,
        time_ns=row.end_ns,
        day=row.day,
        kind=row.kind,
        person=row.person,
        pose=pose,
    )


def _row(outcome: Outcome, day: date, keeping: Keeping) -> OutcomeRow:
    """An outcome as a row; amounts that are no numbers are left out."""
    keep = keeping.keep
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
        counted=outcome.probability >= keeping.sure,
        pose=_pose_numbers(outcome.rig_from_object) if "poses" in keep else None,
        evidence=evidence if evidence and "numbers" in keep else None,
        first_sequence=outcome.first_sequence,
        last_sequence=outcome.last_sequence,
        published=False,
        amounts=[
            AmountRow(name=name, value=amount.value, deviation=amount.deviation)
            for name, amount in outcome.amounts.items()
            if math.isfinite(amount.value) and math.isfinite(amount.deviation)
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
