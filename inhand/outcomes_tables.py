"""What is kept of outcomes, as tables for people and rows for machines."""

from collections.abc import Mapping, Sequence
from datetime import date, timedelta
from typing import Any

import msgspec
from inhand_outcomes.achievement import Amount
from inhand_outcomes.days import first_day, local_time
from inhand_outcomes.floor_map import RegionShare
from inhand_outcomes.keeping import KeepingSettings
from inhand_outcomes.rules import Rules, progress
from inhand_outcomes.store.queries import KeptOutcome, LastPlace
from inhand_outcomes.totals import DayTotal
from inhand_runtime.wording import printable
from rich.table import Table

from inhand.results import listing

UNCERTAIN = "uncertain, not counted"
A_MINUTE_S = 60.0
UNITS = {
    "ml": "ml",
    "deg": "°",
    "m2": "m²",
    "m_s": "m/s",
    "deg_s": "°/s",
    "hz": "Hz",
    "cm": "cm",
    "mm": "mm",
    "s": "s",
    "m": "m",
    "count": "",
}
"""How the unit is written in which the name of an amount ends; longer ends come first."""


def totals_table(totals: Sequence[DayTotal], people: Mapping[int, str], title: str) -> Table:
    """Make a table of a day: what counts, and apart what is too uncertain."""
    table = listing(("object", "what", "who"), ("times", "time"), title)
    table.add_column("amounts", overflow="fold")
    table.add_column("", overflow="fold")
    for total in sorted(totals, key=lambda one: not one.counted):
        amounts = (amount_text(name, amount.amount(name)) for name, amount in total.amounts.items())
        table.add_row(
            printable(total.object),
            words(total.kind),
            person_text(total.person, people),
            str(total.times),
            duration_text(total.seconds),
            ", ".join(amounts),
            "" if total.counted else UNCERTAIN,
        )
    return table


def latest_table(outcomes: Sequence[KeptOutcome], settings: KeepingSettings) -> Table:
    """Make a table of single outcomes, the newest first."""
    table = listing(("at", "object", "what", "who"), ("sure",), "last")
    table.add_column("amounts", overflow="fold")
    for kept in outcomes:
        outcome = kept.outcome
        table.add_row(
            f"{local_time(outcome.end_ns, settings.zone):%H:%M:%S}",
            printable(outcome.object),
            words(outcome.kind),
            person_text(outcome.person, settings.people),
            f"{100.0 * outcome.probability:.0f} %",
            ", ".join(amount_text(name, one) for name, one in outcome.amounts.items()),
        )
    return table


def history_table(
    totals: Sequence[DayTotal], people: Mapping[int, str], first: date, last: date
) -> Table:
    """Make a table of days: a row for each with what counts of each object, kind and person."""
    table = listing(("day", "object", "what", "who"), ("times", "time"), f"{first} to {last}")
    table.add_column("amounts", overflow="fold")
    for total in totals:
        if total.counted:
            amounts = (
                amount_text(name, amount.amount(name)) for name, amount in total.amounts.items()
            )
            table.add_row(
                f"{total.day:%a} {total.day}",
                printable(total.object),
                words(total.kind),
                person_text(total.person, people),
                str(total.times),
                duration_text(total.seconds),
                ", ".join(amounts),
            )
    return table


def days_of(first: date, last: date) -> list[date]:
    """Return all days, both included."""
    return [first + timedelta(days=number) for number in range((last - first).days + 1)]


def goal_rows(rules: Rules, totals: Sequence[DayTotal], today: date) -> list[dict[str, Any]]:
    """Return how far each goal is in the day or week under way, as ``--json`` writes it."""
    return [
        {
            "goal": one.goal.name,
            "per": one.goal.per,
            "amount": one.goal.amount,
            "value": progress(one, totals, first_day(today, one.goal.per)),
            "at_least": one.goal.at_least,
            "at_most": one.goal.at_most,
        }
        for one in rules.goals
    ]


def goals_table(goals: Sequence[Mapping[str, Any]]) -> Table:
    """Make a table of goals, each with what is done and what is wanted."""
    table = listing(("goal", "per", "what"), ("done", "wanted"), "goals")
    for row in goals:
        least, most = row["at_least"], row["at_most"]
        wanted = f"≤ {_number(most)}" if least is None else f"≥ {_number(least)}"
        what, unit = _name_and_unit(row["amount"])
        table.add_row(
            words(row["goal"]), row["per"], what, _number(row["value"]) + unit, wanted + unit
        )
    return table


def region_rows(shares: Mapping[str, RegionShare]) -> list[dict[str, Any]]:
    """Return how much of each region was swept, as ``--json`` writes it."""
    return [
        {
            "region": name,
            "share": one.share,
            "swept_m2": one.swept_m2,
            "swept_deviation_m2": one.deviation_m2,
            "missed_m2": one.missed_m2,
        }
        for name, one in shares.items()
    ]


def regions_table(regions: Sequence[Mapping[str, Any]]) -> Table:
    """Make a table of regions of the floor."""
    table = listing(("region",), ("swept", "m²", "missed m²"), "floor")
    for row in regions:
        table.add_row(
            words(row["region"]),
            f"{100.0 * row['share']:.0f} %",
            f"{row['swept_m2']:.2f} ± {row['swept_deviation_m2']:.2f}",
            f"{row['missed_m2']:.2f}",
        )
    return table


def total_row(total: DayTotal, people: Mapping[int, str]) -> dict[str, Any]:
    """Return a day's total as ``--json`` writes it."""
    amounts = {name: amount.amount(name) for name, amount in total.amounts.items()}
    return {
        "day": total.day.isoformat(),
        "object": total.object,
        "kind": total.kind,
        "person": total.person,
        "name": None if total.person is None else people.get(total.person),
        "counted": total.counted,
        "times": total.times,
        "seconds": total.seconds,
        "amounts": {name: amount.value for name, amount in amounts.items()},
        "deviations": {name: amount.deviation for name, amount in amounts.items()},
    }


def outcome_row(kept: KeptOutcome, settings: KeepingSettings) -> dict[str, Any]:
    """Return an outcome as ``--json`` writes it: its event, with its local time."""
    event = msgspec.to_builtins(kept.outcome.message(0))
    del event["sequence"]
    local = local_time(kept.outcome.end_ns, settings.zone)
    return {"local_time": local.isoformat(), "counted": kept.counted, **event}


def place_row(place: LastPlace, settings: KeepingSettings) -> dict[str, Any]:
    """Return where an object was as ``--json`` writes it."""
    return {
        "object": place.object,
        "time_ns": place.time_ns,
        "local_time": local_time(place.time_ns, settings.zone).isoformat(),
        "kind": place.kind,
        "person": place.person,
        "rig_from_object": msgspec.to_builtins(place.rig_from_object),
    }


def place_text(place: LastPlace, settings: KeepingSettings) -> str:
    """Say where an object was: as the rig's first camera sees it, x right, y down, z forward."""
    x, y, z = place.rig_from_object.translation
    side, height = "right" if x >= 0.0 else "left", "below" if y >= 0.0 else "above"
    depth = "before" if z >= 0.0 else "behind"
    return (
        f"{place.object}: {abs(z):.2f} m {depth} the rig, {abs(x):.2f} m to its {side}, "
        f"{abs(y):.2f} m {height} it, at {local_time(place.time_ns, settings.zone):%Y-%m-%d %H:%M} "
        f"({words(place.kind)}, {person_text(place.person, settings.people)})"
    )


def amount_text(name: str, amount: Amount) -> str:
    """Write an amount with its deviation and unit: ``volume 210 ± 20 ml``."""
    what, unit = _name_and_unit(name)
    if unit == " s" and amount.value >= A_MINUTE_S:
        return f"{what} {duration_text(amount.value)} ± {duration_text(amount.deviation)}"
    return f"{what} {_number(amount.value)} ± {_number(amount.deviation)}{unit}"


def duration_text(seconds: float) -> str:
    """Write a duration in the units that people read."""
    if seconds < A_MINUTE_S:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min {rest:02} s"


def person_text(person: int | None, people: Mapping[int, str]) -> str:
    """Name a person, as the settings do where they do."""
    return "nobody" if person is None else printable(people.get(person, f"person {person}"))


def words(name: str) -> str:
    """Write a name of the messages as words."""
    return printable(name.replace("_", " "))


def _number(value: float) -> str:
    return f"{value:.0f}" if abs(value) >= 100.0 else f"{value:.3g}"


def _name_and_unit(name: str) -> tuple[str, str]:
    """An amount's name in words, and its unit with the space before it."""
    for end, unit in UNITS.items():
        if name.endswith(f"_{end}"):
            return words(name.removesuffix(f"_{end}")), f" {unit}" if unit else ""
    return words(name), ""
