"""Removes what is older than it may be kept; the totals of its days stay for longer."""

from dataclasses import dataclass
from datetime import date, timedelta

from sqlalchemy import CursorResult, Delete, delete
from sqlalchemy.orm import Session

from inhand_outcomes.store.database import Database
from inhand_outcomes.store.models import (
    FloorMapRow,
    GoalMarkRow,
    OutcomeRow,
    PlaceRow,
    TotalAmountRow,
    TotalRow,
)


@dataclass(frozen=True)
class Retention:
    """For how many days before today details and totals are kept; 0 is for ever."""

    days: int = 0
    totals_days: int = 0


def remove_old(database: Database, retention: Retention, today: date) -> int:
    """Remove what is too old; returns the number of outcomes that went. Raises StoreError."""
    removed = 0
    with database.writing() as session:
        if retention.days:
            before = _first_kept(today, retention.days)
            removed = deleted(session, delete(OutcomeRow).where(OutcomeRow.day < before))
            session.execute(delete(FloorMapRow).where(FloorMapRow.day < before))
        if retention.totals_days:
            before = _first_kept(today, retention.totals_days)
            session.execute(delete(TotalAmountRow).where(TotalAmountRow.day < before))
            session.execute(delete(TotalRow).where(TotalRow.day < before))
            session.execute(delete(GoalMarkRow).where(GoalMarkRow.period < before))
            session.execute(delete(PlaceRow).where(PlaceRow.day < before))
    return removed


def _first_kept(today: date, days: int) -> date:
    return today - timedelta(days=min(days, today.toordinal()) - 1)


def deleted(session: Session, statement: Delete) -> int:
    """Remove rows; returns how many there were."""
    result = session.execute(statement)
    assert isinstance(result, CursorResult)
    return result.rowcount
