"""Goals of days and weeks: what is reached, missed, or behind, from totals and a clock.

Each goal is judged again and again; marks of each period say what was said of it already, so that
each event is raised once, over restarts too. A period is judged at its end only where the goal was
known in it (mark ``begun``), and after that (``ended``) nothing more is said of it, whatever the
clock does.
"""

import hashlib
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from datetime import date, time
from typing import Annotated, Literal, Self
from zoneinfo import ZoneInfo

from inhand_runtime.settings import Section
from inhand_runtime.settings_errors import suggestion
from inhand_schemas.messages import Event
from pydantic import AfterValidator, Field, model_validator

from inhand_outcomes.days import (
    DAYS_A_WEEK,
    NS_PER_S,
    Period,
    first_day,
    last_day,
    local_day,
    local_time,
    seconds_of,
)
from inhand_outcomes.kinds import amounts_by_kind
from inhand_outcomes.named import named
from inhand_outcomes.outcome import adds_up
from inhand_outcomes.totals import DayTotal, sum_of_amount

SETTLED_S = 120.0
"""Seconds after its end at which a period is judged: outcomes are settled and saved by then."""
TIMES, DAYS = "times", "days"
A_DAY_S = 86_400.0

NEWS_DAYS = 7
"""Days after the end of a period until which it is said how it ended: who was off for longer says
nothing of it."""

EventKind = Literal["goal_reached", "goal_missed", "reminder"]
REACHED: Literal["goal_reached"] = "goal_reached"
MISSED: Literal["goal_missed"] = "goal_missed"
BEGUN, ENDED = "begun", "ended"


def _clock(clock: time) -> time:
    if clock.tzinfo is not None:
        raise ValueError("write it without a time zone, which is time_zone's")
    return clock


Clock = Annotated[time, AfterValidator(_clock)]
MOST_PERSON = 2**63 - 1
PersonNumber = Annotated[int, Field(ge=0, le=MOST_PERSON)]
"""The number that skeletons have of a person."""


class Goal(Section):
    """``[[outcomes.NAME.goals]]``: how much of a kind there is to be in each day or week.

    ``amount`` is the name of an amount (``volume_ml``), of which the sum counts, or for those that
    do not add up the largest; ``times``, the number of outcomes; or ``days``, the number of local
    days with one, by which "three times a week" means three days. ``object`` and ``person``, a
    number or a name of ``people``, are whose alone counts; without them all count together.
    At ``remind_at`` there is a reminder where less than the day's share is done.
    """

    name: Annotated[str, named("goal")]
    kind: str
    amount: str = TIMES
    at_least: Annotated[float, Field(gt=0, allow_inf_nan=False)] | None = None
    at_most: Annotated[float, Field(ge=0, allow_inf_nan=False)] | None = None
    per: Period = "day"
    object: Annotated[str, named("object")] | None = None
    person: PersonNumber | str | None = None
    remind_at: tuple[Clock, ...] = ()

    @model_validator(mode="after")
    def _fits(self) -> Self:
        kinds = amounts_by_kind()
        if self.kind not in kinds:
            raise ValueError(f"there is no kind {self.kind!r}" + suggestion(self.kind, kinds))
        amounts = (TIMES, DAYS, *sorted(kinds[self.kind]))
        if self.amount not in amounts:
            wrong = f"a {self.kind} has no amount {self.amount!r}"
            raise ValueError(wrong + suggestion(self.amount, amounts))
        if (self.at_least is None) == (self.at_most is None):
            raise ValueError("a goal has at_least or at_most, one of both")
        if self.at_most is not None and self.remind_at:
            raise ValueError("remind_at is for at_least: nobody is behind with at_most")
        if self.amount == DAYS and self.per == "day":
            raise ValueError('amount = "days" is for per = "week"')
        if self.amount == DAYS and self.at_least is not None and self.at_least > DAYS_A_WEEK:
            raise ValueError(f"at_least is {self.at_least:g} days, and a week has {DAYS_A_WEEK}")
        return self

    @property
    def wanted(self) -> float:
        """The number that is not to be missed, or not to be passed."""
        number = self.at_least if self.at_least is not None else self.at_most
        assert number is not None
        return number


class QuietHours(Section):
    """``quiet = {from = "22:00", to = "07:00"}``: no reminders then; the day's share counts from
    their end to their beginning."""

    begin: Clock = Field(alias="from")
    end: Clock = Field(alias="to")

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if self.begin == self.end:
            raise ValueError("from and to are the same: leave quiet out for no quiet hours")
        return self

    def hold(self, clock: time) -> bool:
        """Whether a local time is in them."""
        if self.begin < self.end:
            return self.begin <= clock < self.end
        return clock >= self.begin or clock < self.end

    def share_before(self, clock: time) -> float:
        """Return the share of the waking day that is over at a local time."""
        waking_s = (seconds_of(self.begin) - seconds_of(self.end)) % A_DAY_S
        awake_s = (seconds_of(clock) - seconds_of(self.end)) % A_DAY_S
        return 1.0 if awake_s > waking_s else awake_s / waking_s


@dataclass(frozen=True)
class PersonsGoal:
    """A goal with the number of its person, None for all together."""

    goal: Goal
    person: int | None


@dataclass(frozen=True)
class Mark:
    """What is known of a goal's period: ``begun``, ``goal_reached``, ``ended`` and so on."""

    goal: str
    period: date
    mark: str


@dataclass(frozen=True)
class GoalEvent:
    """What is said of a goal, once: its ``id`` is the same whenever it is said."""

    id: str
    kind: EventKind
    goal: str
    period: date
    time_ns: int
    value: float
    wanted: float
    amount: str
    object: str | None
    person: int | None

    def message(self, sequence: int) -> Event:
        """The event as it is published; its description is the goal's name."""
        return Event(
            sequence=sequence,
            time_ns=self.time_ns,
            kind=self.kind,
            object=self.object,
            person=self.person,
            description=self.goal,
            id=self.id,
            probability=1.0,
            amounts={self.amount: self.value},
            evidence={"wanted": self.wanted},
        )


NewMark = tuple[Mark, GoalEvent | None]
"""A mark, with the event that it stands for, if any."""


@dataclass(frozen=True)
class Rules:
    """All goals, of whom they are, with the zone and the hours in which nobody is reminded."""

    goals: Sequence[PersonsGoal]
    zone: ZoneInfo
    quiet: QuietHours | None = None


def progress(goal: PersonsGoal, totals: Iterable[DayTotal], first: date) -> float:
    """Return how much of a goal is done in the period that begins on a day."""
    last = last_day(first, goal.goal.per)
    found = [
        total
        for total in totals
        if total.counted
        and first <= total.day <= last
        and total.kind == goal.goal.kind
        and goal.goal.object in (None, total.object)
        and goal.person in (None, total.person)
    ]
    if goal.goal.amount == TIMES:
        return float(sum(total.times for total in found))
    if goal.goal.amount == DAYS:
        return float(len({total.day for total in found}))
    amount = sum_of_amount(found, goal.goal.amount)
    if amount is None:
        return 0.0
    return amount.sum if adds_up(goal.goal.amount) else amount.largest


def judge(
    rules: Rules, totals: Sequence[DayTotal], marks: Collection[Mark], now_ns: int
) -> list[NewMark]:
    """Judge each goal at a time, in the periods that are ``open_periods`` and the one under way.

    ``totals`` are of all days of these, and ``marks`` all that there are of them.
    """
    return [
        new
        for goal in rules.goals
        for period in _periods(rules, goal.goal, marks, now_ns)
        for new in _judge_period(rules, goal, period, totals, marks, now_ns)
    ]


def open_periods(marks: Iterable[Mark]) -> set[tuple[str, date]]:
    """Return the goals and periods that were begun and have not ended."""
    marks = set(marks)
    begun = {(mark.goal, mark.period) for mark in marks if mark.mark == BEGUN}
    return begun - {(mark.goal, mark.period) for mark in marks if mark.mark == ENDED}


def _periods(rules: Rules, goal: Goal, marks: Collection[Mark], now_ns: int) -> list[date]:
    """First days of the periods of a goal that are to be judged."""
    current = first_day(local_day(now_ns, rules.zone), goal.per)
    periods = {period for name, period in open_periods(marks) if name == goal.name}
    if Mark(goal.name, current, ENDED) not in marks:
        periods.add(current)
    # One that is to come was begun by a clock that was wrong.
    return sorted(period for period in periods if period <= current)


def _judge_period(
    rules: Rules,
    goal: PersonsGoal,
    period: date,
    totals: Sequence[DayTotal],
    marks: Collection[Mark],
    now_ns: int,
) -> list[NewMark]:
    name = goal.goal.name
    settled_day = local_day(now_ns - round(SETTLED_S * NS_PER_S), rules.zone)
    days_over = (settled_day - last_day(period, goal.goal.per)).days
    said = {mark.mark for mark in marks if (mark.goal, mark.period) == (name, period)}
    value = progress(goal, totals, period)
    new: list[NewMark] = []
    if BEGUN not in said:
        new.append((Mark(name, period, BEGUN), None))
    if days_over > 0:
        new.append((Mark(name, period, ENDED), None))
    kind = _verdict(goal.goal, value, over=days_over > 0)
    if kind is not None and not said & {REACHED, MISSED} and days_over <= NEWS_DAYS:
        new.append((Mark(name, period, kind), _event(goal, kind, kind, period, now_ns, value)))
    if days_over <= 0:
        new += _reminders(rules, goal, period, said, value, now_ns)
    return new


def _verdict(goal: Goal, value: float, *, over: bool) -> EventKind | None:
    """What a value says of a goal, None where that is open still."""
    if goal.at_least is not None:
        if value >= goal.wanted:
            return REACHED
        return MISSED if over else None
    if value > goal.wanted:
        return MISSED
    return REACHED if over else None


def _reminders(
    rules: Rules, goal: PersonsGoal, period: date, said: set[str], value: float, now_ns: int
) -> list[NewMark]:
    """Marks of the reminders that are due; the latest has an event where the goal is behind."""
    now = local_time(now_ns, rules.zone)
    day, clock = now.date(), now.time()
    if rules.quiet is not None and rules.quiet.hold(clock):
        return []
    times = [at for at in sorted(goal.goal.remind_at) if at <= clock]
    due = [at for at in times if _reminder(day, at) not in said]
    new: list[NewMark] = [(Mark(goal.goal.name, period, _reminder(day, at)), None) for at in due]
    if due and value < goal.goal.wanted * _share(rules, goal.goal, day, due[-1]):
        mark = new[-1][0]
        new[-1] = (mark, _event(goal, "reminder", mark.mark, period, now_ns, value))
    return new


def _reminder(day: date, at: time) -> str:
    return f"reminder {day} {at:%H:%M:%S}"


def _share(rules: Rules, goal: Goal, day: date, at: time) -> float:
    """Share of the period that is over at a time of a day."""
    of_day = seconds_of(at) / A_DAY_S if rules.quiet is None else rules.quiet.share_before(at)
    if goal.per == "day":
        return of_day
    return ((day - first_day(day, "week")).days + of_day) / DAYS_A_WEEK


def _event(
    goal: PersonsGoal, kind: EventKind, mark: str, period: date, now_ns: int, value: float
) -> GoalEvent:
    text = f"{goal.goal.name}/{period}/{mark}"
    return GoalEvent(
        id=hashlib.blake2b(text.encode(), digest_size=12).hexdigest(),
        kind=kind,
        goal=goal.goal.name,
        period=period,
        time_ns=now_ns,
        value=value,
        wanted=goal.goal.wanted,
        amount=goal.goal.amount,
        object=goal.goal.object,
        person=goal.person,
    )
