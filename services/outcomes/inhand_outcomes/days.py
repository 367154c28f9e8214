"""Local days and weeks of a named time zone."""

from datetime import UTC, date, datetime, time, timedelta
from typing import Literal
from zoneinfo import ZoneInfo

Period = Literal["day", "week"]

NS_PER_S = 1_000_000_000
DAYS_A_WEEK = 7


def local_time(time_ns: int, zone: ZoneInfo) -> datetime:
    """Return the local time, to the microsecond below, of nanoseconds since the epoch."""
    seconds, rest_ns = divmod(time_ns, NS_PER_S)
    return (
        datetime.fromtimestamp(seconds, UTC).replace(microsecond=rest_ns // 1000).astimezone(zone)
    )


def local_day(time_ns: int, zone: ZoneInfo) -> date:
    """Return the local date of nanoseconds since the epoch."""
    return local_time(time_ns, zone).date()


def first_day(day: date, period: Period) -> date:
    """Return the day on which the period of a day begins: itself, or the Monday of its week."""
    return day if period == "day" else day - timedelta(days=day.weekday())


def last_day(first: date, period: Period) -> date:
    """Return the last day of the period that begins on a day."""
    return first if period == "day" else first + timedelta(days=DAYS_A_WEEK - 1)


def seconds_of(clock: time) -> float:
    """Return the seconds since midnight that a clock on the wall shows."""
    return clock.hour * 3600 + clock.minute * 60 + clock.second
