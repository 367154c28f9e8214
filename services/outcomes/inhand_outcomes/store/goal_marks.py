"""Judges goals on the totals that are kept, and remembers what was said of them."""

from collections.abc import Iterable, Sequence
from datetime import date

import msgspec
from inhand_schemas.messages import Event
from sqlalchemy import select
from sqlalchemy.orm import Session

from inhand_outcomes.days import first_day, last_day, local_day
from inhand_outcomes.rules import BEGUN, ENDED, Mark, NewMark, Rules, judge, open_periods
from inhand_outcomes.store.database import Database
from inhand_outcomes.store.models import GoalMarkRow
from inhand_outcomes.store.queries import read_totals
from inhand_outcomes.store.saving import number_of


def judge_goals(database: Database, rules: Rules, now_ns: int) -> int:
    """Judge all goals on the totals of now; returns the number of events that this raised.

    They stay in ``events_to_publish`` until they are published. Raises StoreError.
    """
    with database.reading() as session:
        if not _new_marks(session, rules, now_ns):
            return 0
    with database.writing() as session:
        new = _new_marks(session, rules, now_ns)
        periods = {one.goal.name: one.goal.per for one in rules.goals}
        people = {one.goal.name: one.person for one in rules.goals}
        session.add_all(
            GoalMarkRow(
                goal=mark.goal,
                period=mark.period,
                mark=mark.mark,
                last_day=last_day(mark.period, periods[mark.goal]),
                person=number_of(people[mark.goal]),
                event=None if event is None else msgspec.to_builtins(event.message(0)),
                published=event is None,
            )
            for mark, event in new
        )
    return sum(event is not None for _, event in new)


def events_to_publish(database: Database) -> list[Event]:
    """Return the events that were raised and not published yet, the oldest first, each with the
    sequence 0; raises StoreError."""
    question = select(GoalMarkRow.event).where(GoalMarkRow.published.is_(False))
    with database.reading() as session:
        events = [msgspec.convert(one, Event) for one in session.scalars(question) if one]
    return sorted(events, key=lambda event: (event.time_ns, event.id or ""))


def mark_published(database: Database, events: Iterable[Event]) -> None:
    """Take note that events went out; raises StoreError."""
    said = {event.id for event in events}
    table = GoalMarkRow
    with database.writing() as session:
        for row in session.scalars(select(table).where(table.published.is_(False))):
            row.published = row.event is not None and row.event["id"] in said


def _new_marks(session: Session, rules: Rules, now_ns: int) -> list[NewMark]:
    if not rules.goals:
        return []
    today = local_day(now_ns, rules.zone)
    names = [one.goal.name for one in rules.goals]
    marks = _marks(session, names, first_day(today, "week"))
    first = min(
        *(first_day(today, one.goal.per) for one in rules.goals),
        *(period for _, period in open_periods(marks)),
        today,
    )
    kinds = {one.goal.kind for one in rules.goals}
    return judge(rules, read_totals(session, first, today, kinds), marks, now_ns)


def _marks(session: Session, goals: Sequence[str], since: date) -> set[Mark]:
    """All marks of the periods that begin then or later, or have not ended."""
    table = GoalMarkRow
    ended = select(table.goal, table.period).where(table.mark == ENDED).subquery()
    begun = (
        select(table.goal, table.period)
        .outerjoin(ended, (ended.c.goal == table.goal) & (ended.c.period == table.period))
        .where(table.mark == BEGUN, (table.period >= since) | ended.c.goal.is_(None))
        .subquery()
    )
    rows = session.execute(
        select(table.goal, table.period, table.mark)
        .join(begun, (begun.c.goal == table.goal) & (begun.c.period == table.period))
        .where(table.goal.in_(goals))
    )
    return {Mark(goal, period, mark) for goal, period, mark in rows}
