"""Goals are reached, missed and reminded of once each, by local days, whatever a clock does."""

from collections.abc import Iterable
from datetime import date, time
from zoneinfo import ZoneInfo

import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_outcomes.days import local_day
from inhand_outcomes.rules import Goal, GoalEvent, Mark, PersonsGoal, QuietHours, Rules, judge
from inhand_outcomes.totals import AmountTotal, DayTotal
from kept_outcomes import ZURICH, S, at
from pydantic import ValidationError

DRINK = Goal(name="drink", kind="sip", amount="volume_ml", at_least=1500)
WEIGHTS = Goal(name="weights", kind="repetition", amount="days", at_least=3, per="week")
COFFEE = Goal(name="coffee", kind="sip", object="cup", at_most=2)
QUIET = QuietHours(**{"from": "22:00", "to": "07:00"})
SANTIAGO = ZoneInfo("America/Santiago")
HOUR = 3600 * S


def total(day: str, ml: float = 0.0, **changes: object) -> DayTotal:
    values = {"kind": "sip", "object": "mug", "person": 0, "counted": True, "times": 1, **changes}
    amounts = {"volume_ml": AmountTotal(1, ml, 1.0, ml)} if ml else {}
    return DayTotal(date.fromisoformat(day), seconds=2.0, amounts=amounts, **values)  # type: ignore[arg-type]


class Judged:
    """What a daemon does: it judges again and again, and keeps the marks."""

    def __init__(self, *goals: Goal, zone: ZoneInfo = ZURICH, quiet: QuietHours | None = None):
        self.rules = Rules([PersonsGoal(goal, None) for goal in goals], zone, quiet)
        self.marks: set[Mark] = set()

    def __call__(self, now_ns: int, totals: Iterable[DayTotal] = ()) -> list[GoalEvent]:
        new = judge(self.rules, list(totals), self.marks, now_ns)
        assert not self.marks.intersection(mark for mark, _ in new)
        self.marks.update(mark for mark, _ in new)
        return [event for _, event in new if event is not None]

    def at(self, text: str, *totals: DayTotal) -> list[tuple[str, str]]:
        """Kinds of the events at a local time, with the days of their periods."""
        events = self(at(text, self.rules.zone), totals)
        return [(event.kind, event.period.isoformat()) for event in events]


def test_a_goal_is_reached_once_when_its_amount_is() -> None:
    judged = Judged(DRINK)
    assert judged.at("2026-05-05 09:00", total("2026-05-05", 1499.9)) == []
    assert judged.at("2026-05-05 10:00", total("2026-05-05", 1500.0)) == [
        ("goal_reached", "2026-05-05")
    ]
    assert judged.at("2026-05-05 11:00", total("2026-05-05", 2000.0)) == []
    assert judged.at("2026-05-06 09:00", total("2026-05-05", 2000.0)) == []


def test_a_goal_is_missed_after_local_midnight_once_all_is_settled() -> None:
    judged, drunk = Judged(DRINK), total("2026-05-05", 900.0)
    assert judged.at("2026-05-05 23:59", drunk) == []
    assert judged.at("2026-05-06 00:01", drunk) == []
    (event,) = judged(at("2026-05-06 00:03"), [drunk])
    assert (event.kind, event.value, event.wanted) == ("goal_missed", 900.0, 1500.0)
    message = event.message(4)
    assert (message.description, message.amounts) == ("drink", {"volume_ml": 900.0})
    assert judged.at("2026-05-06 00:04", drunk) == []


def test_what_is_settled_just_after_midnight_reaches_the_goal_of_its_day() -> None:
    judged = Judged(DRINK)
    judged.at("2026-05-05 23:59", total("2026-05-05", 900.0))
    assert judged.at("2026-05-06 00:01", total("2026-05-05", 1600.0)) == [
        ("goal_reached", "2026-05-05")
    ]


@pytest.mark.parametrize(
    ("zone", "day", "hours", "after"),
    [
        (ZURICH, "2026-03-29", 23, "2026-03-30"),
        (ZURICH, "2026-10-25", 25, "2026-10-26"),
        # There clocks go from midnight to one, and from midnight back to eleven.
        (SANTIAGO, "2026-09-05", 24, "2026-09-06"),
        (SANTIAGO, "2026-09-06", 23, "2026-09-07"),
        (SANTIAGO, "2026-04-04", 25, "2026-04-05"),
    ],
)
def test_a_day_of_a_clock_change_ends_once_after_its_own_hours(
    zone: ZoneInfo, day: str, hours: int, after: str
) -> None:
    judged = Judged(DRINK, zone=zone)
    noon = at(f"{day} 12:00", zone)
    midnight = min(
        minute
        for minute in range(noon, noon + 20 * HOUR, 60 * S)
        if local_day(minute, zone).isoformat() == after
    )
    first = min(
        minute
        for minute in range(noon - 20 * HOUR, noon, 60 * S)
        if local_day(minute, zone).isoformat() == day
    )
    assert midnight - first == hours * HOUR
    events = [
        (event.kind, event.period.isoformat(), (now - midnight) // S)
        for now in range(first, midnight + HOUR, 30 * S)
        for event in judged(now)
    ]
    assert events == [("goal_missed", day, 120)]


@given(st.lists(st.integers(-90_000, 90_000), min_size=1, max_size=40))
def test_no_step_of_the_clock_says_anything_twice(steps: list[int]) -> None:
    judged = Judged(
        DRINK, Goal(**{**dict(DRINK), "name": "early", "remind_at": (time(9), time(15))})
    )
    now, ids = at("2026-03-28 12:00"), []
    for step in steps:
        now += step * S
        ids += [event.id for event in judged(now)]
    assert len(set(ids)) == len(ids)


def test_a_clock_that_goes_back_over_midnight_begins_no_day_again() -> None:
    judged = Judged(DRINK)
    judged.at("2026-05-05 23:00")
    assert judged.at("2026-05-06 00:30") == [("goal_missed", "2026-05-05")]
    assert judged.at("2026-05-05 23:30", total("2026-05-05", 2000.0)) == []
    assert judged.at("2026-05-06 00:30", total("2026-05-05", 2000.0)) == []
    assert judged.at("2026-05-07 00:30") == [("goal_missed", "2026-05-06")]


def test_days_on_which_nobody_looked_are_not_missed() -> None:
    judged = Judged(DRINK)
    judged.at("2026-05-05 12:00")
    assert judged.at("2026-05-08 12:00") == [("goal_missed", "2026-05-05")]
    assert judged.at("2026-06-20 12:00") == []  # nobody wants to hear of the 8th now
    assert judged.at("2026-06-21 12:00") == [("goal_missed", "2026-06-20")]


def test_three_times_a_week_are_three_days_from_monday_to_sunday() -> None:
    days = ["2026-05-04", "2026-05-06", "2026-05-10"]
    lifted = [total(day, kind="repetition", times=12) for day in days]
    judged = Judged(WEIGHTS)
    sunday_before = total("2026-05-03", kind="repetition")
    assert judged.at("2026-05-06 20:00", sunday_before, *lifted[:2]) == []
    assert judged.at("2026-05-10 20:00", sunday_before, *lifted) == [("goal_reached", "2026-05-04")]
    assert judged.at("2026-05-12 20:00", sunday_before, *lifted) == []
    assert judged.at("2026-05-18 00:03", sunday_before, *lifted) == [("goal_missed", "2026-05-11")]


def test_more_than_at_most_is_missed_at_once_and_less_is_reached_at_the_end() -> None:
    judged, cups = (
        Judged(COFFEE),
        [total(f"2026-05-0{day}", object="cup", times=day) for day in (2, 3)],
    )
    assert judged.at("2026-05-02 20:00", *cups) == []
    assert judged.at("2026-05-03 20:00", *cups) == [
        ("goal_reached", "2026-05-02"),
        ("goal_missed", "2026-05-03"),
    ]
    assert judged.at("2026-05-04 20:00", *cups) == []


def test_only_what_is_sure_and_of_the_goals_object_and_person_counts() -> None:
    goal = Goal(name="own", kind="sip", object="mug", at_least=2)
    rules = Rules([PersonsGoal(goal, 1)], ZURICH)
    others: list[dict[str, object]] = [
        {"counted": False},
        {"person": 0},
        {"person": None},
        {"object": "cup"},
        {"kind": "refill"},
    ]
    day = "2026-05-05"
    totals = [total(day, times=9, **{"person": 1, **other}) for other in others]
    own = total(day, times=1, person=1)
    now = at(f"{day} 12:00")
    assert [event for _, event in judge(rules, [*totals, own], set(), now) if event] == []
    assert [event for _, event in judge(rules, [own, own], set(), now) if event] != []


def test_whoever_is_behind_the_days_share_is_reminded_once() -> None:
    # From 7 to 22 o'clock 15 hours are awake, of which 8 are over at 15: 800 of 1500 ml.
    goal = Goal(**{**dict(DRINK), "remind_at": (time(15), time(18))})
    judged = Judged(goal, quiet=QUIET)
    little = total("2026-05-05", 799.0)
    assert judged.at("2026-05-05 14:59", little) == []
    assert judged.at("2026-05-05 15:00", little) == [("reminder", "2026-05-05")]
    assert judged.at("2026-05-05 15:01", little) == []
    assert judged.at("2026-05-05 18:01", total("2026-05-05", 1100.0)) == []
    assert judged.at("2026-05-06 15:00", total("2026-05-06", 800.0)) == [
        ("goal_missed", "2026-05-05")
    ]
    assert judged.at("2026-05-06 15:30", total("2026-05-06", 1.0)) == []


def test_nobody_is_reminded_in_quiet_hours_nor_of_what_is_over() -> None:
    judged = Judged(Goal(**{**dict(DRINK), "remind_at": (time(15), time(18))}), quiet=QUIET)
    assert judged.at("2026-05-05 23:00") == []
    assert judged.at("2026-05-06 08:00") == [("goal_missed", "2026-05-05")]
    assert judged.at("2026-05-06 19:00") == [("reminder", "2026-05-06")]  # of both times together


@pytest.mark.parametrize("day", ["2026-03-29", "2026-10-25"])
def test_a_time_that_is_twice_or_never_reminds_once(day: str) -> None:
    judged = Judged(Goal(**{**dict(DRINK), "remind_at": (time(2, 30),)}))
    first = at(f"{day} 00:10")
    said = [event.kind for now in range(first, first + 6 * HOUR, 300 * S) for event in judged(now)]
    assert said == ["reminder"]


def test_a_weeks_share_grows_with_its_days() -> None:
    judged = Judged(Goal(**{**dict(WEIGHTS), "remind_at": (time(12),)}))
    lifted = total("2026-05-04", kind="repetition")
    assert judged.at("2026-05-06 12:00", lifted) == [("reminder", "2026-05-04")]  # 3 × 2.5 / 7 > 1
    assert judged.at("2026-05-05 12:00", lifted) == []  # 3 × 1.5 / 7 < 1


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"at_most": 3}, "one of both"),
        ({"at_least": None}, "one of both"),
        ({"name": "Drink more"}, "is no name"),
        ({"amount": "days"}, 'for per = "week"'),
        ({"at_least": None, "at_most": 1, "remind_at": ("15:00",)}, "nobody is behind"),
        ({"at_least": float("nan")}, "finite"),
        ({"remind_at": ("15:00Z",)}, "without a time zone"),
    ],
)
def test_a_goal_that_cannot_be_meant_is_refused(changes: dict[str, object], line: str) -> None:
    with pytest.raises(ValidationError, match=line):
        Goal.model_validate({"name": "drink", "kind": "sip", "at_least": 1, **changes})
