"""Removes what nobody shall know any more: of a person, of a day, or all of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date

from sqlalchemy import ColumnElement, Connection, Delete, Engine, delete, func, select, text, true
from sqlalchemy.orm import Session

from inhand_outcomes.store.database import Database
from inhand_outcomes.store.failures import StoreError, explained
from inhand_outcomes.store.models import (
    NOBODY,
    Base,
    FloorMapRow,
    ForgottenRow,
    GoalMarkRow,
    JournalRow,
    OutcomeRow,
    PlaceRow,
    TotalAmountRow,
    TotalRow,
)
from inhand_outcomes.store.retention import deleted
from inhand_outcomes.store.saving import STANDING, number_of, place_of


@dataclass(frozen=True)
class Forget:
    """What is to be forgotten: what one person did, or one local day, or everything."""

    person: int | None = None
    day: date | None = None
    everything: bool = False

    def __post_init__(self) -> None:
        if (self.person is not None) + (self.day is not None) + self.everything != 1:
            raise ValueError("one of person, day and everything")


@dataclass(frozen=True)
class Removed:
    """Numbers of what was removed: outcomes, totals of days, places of objects, maps of floors,
    and what was noted of goals."""

    outcomes: int
    totals: int
    places: int
    floor_maps: int
    goals: int


def forget(database: Database, what: Forget, now_ns: int) -> Removed:
    """Remove it from details and totals, with the memory in the journal, which may hold any of it.

    The places that go are replaced by those that other outcomes say. What was noted of goals goes
    where it counts any of it. What was removed is written over in the files. A daemon that runs
    meanwhile learns of it when it saves next. Raises StoreError.
    """
    with database.writing() as session:
        totals_gone = deleted(session, _of(what, TotalRow))
        session.execute(_of(what, TotalAmountRow))
        outcomes_gone = deleted(session, _of(what, OutcomeRow))
        places_gone = _forget_places(session, what)
        maps_gone = deleted(session, _of(what, FloorMapRow))
        goals_gone = deleted(session, delete(GoalMarkRow).where(_chosen_marks(what)))
        session.execute(delete(JournalRow).where(JournalRow.name.not_like(f"{STANDING}%")))
        newest = session.scalar(select(func.max(ForgottenRow.number))) or 0
        session.add(
            ForgottenRow(number=newest + 1, time_ns=now_ns, person=what.person, day=what.day)
        )
    try:
        _write_over(database)
    except StoreError as error:
        raise StoreError(
            f"it was removed, but its bytes may still stand in the files; forget it again: {error}"
        ) from error
    return Removed(outcomes_gone, totals_gone, places_gone, maps_gone, goals_gone)


Rows = type[OutcomeRow] | type[TotalRow] | type[TotalAmountRow] | type[PlaceRow] | type[FloorMapRow]


def _of(what: Forget, table: Rows) -> Delete:
    if what.everything:
        return delete(table)
    if what.day is not None:
        return delete(table).where(table.day == what.day)
    return delete(table).where(table.person == number_of(what.person))


def _chosen_marks(what: Forget) -> ColumnElement[bool]:
    if what.everything:
        return true()
    if what.day is not None:
        return (GoalMarkRow.period <= what.day) & (GoalMarkRow.last_day >= what.day)
    return GoalMarkRow.person.in_((number_of(what.person), NOBODY))


def _forget_places(session: Session, what: Forget) -> int:
    before = set(session.scalars(select(PlaceRow.object)))
    gone = deleted(session, _of(what, PlaceRow))
    left: Sequence[str] = session.scalars(select(PlaceRow.object)).all()
    for object_name in before.difference(left):
        said = (OutcomeRow.object == object_name) & OutcomeRow.counted
        row = session.scalar(
            select(OutcomeRow)
            .where(said & OutcomeRow.pose.is_not(None))
            .order_by(OutcomeRow.end_ns.desc())
            .limit(1)
        )
        if row is not None and row.pose is not None:
            session.add(place_of(row, row.pose))
    return gone


def _write_over(database: Database) -> None:
    """Leave nothing of what was removed in the files of the database."""
    with explained(database.name), _bare(database.engine) as connection:
        if database.engine.dialect.name == "postgresql":
            for table in Base.metadata.sorted_tables:
                connection.execute(text(f"VACUUM (FULL) {table.name}"))
            return
        connection.exec_driver_sql("VACUUM")
        busy = connection.exec_driver_sql("PRAGMA wal_checkpoint(TRUNCATE)").scalar()
        if busy:
            raise StoreError(f"the database {database.name}: another process reads it for long")


def _bare(engine: Engine) -> Connection:
    """A connection whose statements are in no transaction."""
    if engine.dialect.name == "postgresql":
        return engine.connect().execution_options(isolation_level="AUTOCOMMIT")
    return engine.connect().execution_options(inhand_bare=True)
