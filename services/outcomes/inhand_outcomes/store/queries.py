"""What the store answers: totals of days, the latest outcomes, and where things are."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import date
from typing import Any

from inhand_schemas.messages import Pose
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from inhand_outcomes.achievement import Amount
from inhand_outcomes.outcome import Outcome
from inhand_outcomes.store.database import Database
from inhand_outcomes.store.models import OutcomeRow, PlaceRow, TotalAmountRow, TotalRow
from inhand_outcomes.store.saving import person_of
from inhand_outcomes.totals import AmountTotal, DayTotal


@dataclass(frozen=True)
class KeptOutcome:
    """An outcome with its local day, and whether it was sure enough to count."""

    outcome: Outcome
    day: date
    counted: bool


@dataclass(frozen=True)
class LastPlace:
    """Where an object was at ``time_ns``, when an outcome of a kind ended."""

    object: str
    time_ns: int
    day: date
    kind: str
    person: int | None
    rig_from_object: Pose


def totals(database: Database, first: date, last: date) -> list[DayTotal]:
    """Return the totals of local days, both included, in order; raises StoreError."""
    with database.reading() as session:
        return read_totals(session, first, last)


def read_totals(
    session: Session, first: date, last: date, kinds: Iterable[str] | None = None
) -> list[DayTotal]:
    """Return the totals of local days within a transaction, of all kinds or only some."""
    total, amount = TotalRow, TotalAmountRow
    of_totals = select(total.__table__).where(total.day.between(first, last))
    of_amounts = select(amount.__table__).where(amount.day.between(first, last))
    if kinds is not None:
        chosen = list(kinds)
        of_totals = of_totals.where(total.kind.in_(chosen))
        of_amounts = of_amounts.where(amount.kind.in_(chosen))
    amounts: dict[tuple[Any, ...], dict[str, AmountTotal]] = defaultdict(dict)
    for row in session.execute(of_amounts.order_by(amount.name)):
        key = (row.day, row.kind, row.object, row.person, row.counted)
        amounts[key][row.name] = AmountTotal(row.times, row.sum, row.variance, row.largest)
    order = (total.day, total.object, total.kind, total.person, total.counted.desc())
    of_totals = of_totals.order_by(*order)
    return [
        DayTotal(
            row.day,
            row.kind,
            row.object,
            person_of(row.person),
            row.counted,
            row.times,
            row.seconds,
            amounts.get((row.day, row.kind, row.object, row.person, row.counted), {}),
        )
        for row in session.execute(of_totals)
    ]


def latest(
    database: Database, most: int, *, day: date | None = None, object_name: str | None = None
) -> list[KeptOutcome]:
    """Return the outcomes that ended last, the newest first; raises StoreError."""
    question = select(OutcomeRow).order_by(OutcomeRow.end_ns.desc(), OutcomeRow.id).limit(most)
    if day is not None:
        question = question.where(OutcomeRow.day == day)
    if object_name is not None:
        question = question.where(OutcomeRow.object == object_name)
    with database.reading() as session:
        return [_kept(row) for row in session.scalars(question)]


def outcomes_to_publish(database: Database, most: int) -> list[Outcome]:
    """Return outcomes that were saved and not published yet, as they are kept, the earliest first;
    raises StoreError."""
    waiting = select(OutcomeRow).where(~OutcomeRow.published)
    question = waiting.order_by(OutcomeRow.end_ns, OutcomeRow.id).limit(most)
    with database.reading() as session:
        return [_kept(row).outcome for row in session.scalars(question)]


def last_places(database: Database, objects: Iterable[str] | None = None) -> list[LastPlace]:
    """Return where each object was last, or those of ``objects`` that are known, by name; raises
    StoreError."""
    question = select(PlaceRow).order_by(PlaceRow.object)
    if objects is not None:
        question = question.where(PlaceRow.object.in_(list(objects)))
    with database.reading() as session:
        return [
            LastPlace(
                row.object, row.time_ns, row.day, row.kind, person_of(row.person), _pose(row.pose)
            )
            for row in session.scalars(question)
        ]


def days_kept(database: Database) -> tuple[date, date] | None:
    """Return the first and the last day of which there are totals; raises StoreError."""
    with database.reading() as session:
        first, last = session.execute(select(func.min(TotalRow.day), func.max(TotalRow.day))).one()
    return None if first is None else (first, last)


def _kept(row: OutcomeRow) -> KeptOutcome:
    outcome = Outcome(
        id=row.id,
        kind=row.kind,
        object=row.object,
        person=person_of(row.person),
        start_ns=row.start_ns,
        end_ns=row.end_ns,
        probability=row.probability,
        amounts={one.name: Amount(one.value, one.deviation) for one in row.amounts},
        evidence={name: value for name, value in (row.evidence or {}).items() if value is not None},
        rig_from_object=None if row.pose is None else _pose(row.pose),
        first_sequence=row.first_sequence,
        last_sequence=row.last_sequence,
    )
    return KeptOutcome(outcome, row.day, row.counted)


def _pose(numbers: Sequence[float]) -> Pose:
    x, y, z, w, i, j, k = numbers
    return Pose((x, y, z), (w, i, j, k))
