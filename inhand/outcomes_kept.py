"""What is kept of outcomes, on the command line: ``inhand outcomes today`` and others."""

import argparse
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from datetime import date, timedelta
from pathlib import Path
from time import time_ns
from typing import Any

from inhand_outcomes.days import first_day, local_day
from inhand_outcomes.keeping import KeepingSettings, open_kept
from inhand_outcomes.regions import shares_of
from inhand_outcomes.store.database import Database
from inhand_outcomes.store.floor_maps import floor_maps
from inhand_outcomes.store.queries import last_places, latest, totals
from inhand_runtime.errors import InhandError
from inhand_runtime.exit_codes import DONE
from inhand_runtime.settings import load_settings
from inhand_runtime.settings_errors import suggestion
from inhand_runtime.wording import printable
from inhand_runtime.writable import require_writable_file

from inhand.looking import output
from inhand.outcomes_forget import add_forget, forget_kept
from inhand.outcomes_tables import (
    goal_rows,
    goals_table,
    history_table,
    latest_table,
    outcome_row,
    place_row,
    place_text,
    region_rows,
    regions_table,
    total_row,
    totals_table,
)
from inhand.outcomes_words import COMMANDS
from inhand.results import write_json

LATEST = 10
"""Number of the last outcomes of a day that are shown."""
WEEK_DAYS = 7


@dataclass(frozen=True)
class Kept:
    """What an instance keeps, and its settings."""

    database: Database
    settings: KeepingSettings

    @property
    def today(self) -> date:
        """The local date."""
        return local_day(time_ns(), self.settings.zone)


def ask(given: Sequence[str], model: type[KeepingSettings] = KeepingSettings) -> int:
    """Answer from what an instance keeps, or remove some of it; returns the exit code.

    ``model`` is that of ``[outcomes.NAME]``. Raises SettingsError, and InhandError for a database
    that cannot be read or written.
    """
    arguments = _parser().parse_args(given)
    for name in ("json", "plot", "map"):
        if (path := getattr(arguments, name, None)) is not None:
            require_writable_file(path)
    settings = load_settings(arguments.config, "outcomes", model, arguments.name).service
    file = settings.database_file
    if file is not None and not file.exists():
        raise InhandError(f"nothing was kept yet: there is no {file}; run `inhand outcomes` first")
    with closing(open_kept(settings)) as database:
        result = _RUN[arguments.verb](Kept(database, settings), arguments)
    if arguments.json is not None:
        write_json(arguments.json, result)
    return DONE


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="inhand outcomes", description="Look at what is kept of outcomes."
    )
    verbs = parser.add_subparsers(dest="verb", required=True)
    by_name = {}
    for verb, text in COMMANDS.items():
        one = verbs.add_parser(verb, help=text, description=f"{text[0].upper()}{text[1:]}.")
        one.add_argument("--config", type=Path, metavar="FILE", help="the rig's settings (TOML)")
        one.add_argument("--name", help="which instance of the file, where it names several")
        one.add_argument("--json", type=Path, metavar="FILE", help="write the answer there")
        by_name[verb] = one
    by_name["today"].add_argument(
        "--map", type=Path, metavar="FILE", help="draw what was swept of the floor there (PNG)"
    )
    by_name["history"].add_argument(
        "--days", type=_days, default=WEEK_DAYS, metavar="N", help="with today (default: 7)"
    )
    by_name["history"].add_argument(
        "--plot", type=Path, metavar="FILE", help="draw them there (PNG)"
    )
    by_name["where"].add_argument("object", metavar="OBJECT")
    add_forget(by_name["forget"])
    return parser


def _days(text: str) -> int:
    days = int(text)
    if not 1 <= days <= 36_600:
        raise argparse.ArgumentTypeError("1 to 36600 days")
    return days


def _show_today(kept: Kept, arguments: argparse.Namespace) -> dict[str, Any]:
    today = kept.today
    week = totals(kept.database, first_day(today, "week"), today)
    found = [total for total in week if total.day == today]
    goals = goal_rows(kept.settings.rules, week, today)
    last = latest(kept.database, LATEST, day=today)
    if found:
        output().print(totals_table(found, kept.settings.people, f"{today}"))
        output().print(latest_table(last, kept.settings))
    else:
        print(f"{today}: nothing was done")
    if goals:
        output().print(goals_table(goals))
    regions = _regions(kept, today)
    if regions:
        output().print(regions_table(regions))
    if arguments.map is not None:
        _draw_map(kept, today, arguments.map)
    return {
        "day": today.isoformat(),
        "time_zone": kept.settings.time_zone,
        "totals": [total_row(total, kept.settings.people) for total in found],
        "goals": goals,
        "regions": regions,
        "latest": [outcome_row(one, kept.settings) for one in last],
    }


def _regions(kept: Kept, day: date) -> list[dict[str, Any]]:
    """How much of each region of the floor was swept on a day."""
    if not kept.settings.regions:
        return []
    try:
        shares = shares_of(floor_maps(kept.database, day), kept.settings.regions)
    except ValueError as error:
        raise InhandError(str(error)) from None
    return region_rows(shares)


def _show_history(kept: Kept, arguments: argparse.Namespace) -> dict[str, Any]:
    last = kept.today
    first = last - timedelta(days=arguments.days - 1)
    found = totals(kept.database, first, last)
    if found:
        output().print(history_table(found, kept.settings.people, first, last))
    else:
        print(f"{first} to {last}: nothing was done")
    if arguments.plot is not None:
        # Matplotlib takes a second to load.
        from inhand.outcomes_plot import draw_history

        draw_history(found, first, last, arguments.plot)
        print(f"drawn in {arguments.plot}")
    return {
        "first": first.isoformat(),
        "last": last.isoformat(),
        "time_zone": kept.settings.time_zone,
        "totals": [total_row(total, kept.settings.people) for total in found],
    }


def _show_where(kept: Kept, arguments: argparse.Namespace) -> dict[str, Any]:
    places = {place.object: place for place in last_places(kept.database)}
    place = places.get(arguments.object)
    if place is None:
        known = suggestion(arguments.object, sorted(places)) if places else ""
        raise InhandError(printable(f"{arguments.object} was seen nowhere yet{known}"))
    print(place_text(place, kept.settings))
    return place_row(place, kept.settings)


def _forget(kept: Kept, arguments: argparse.Namespace) -> dict[str, Any]:
    return forget_kept(kept.database, kept.settings, arguments)


def _draw_map(kept: Kept, day: date, path: Path) -> None:
    maps = floor_maps(kept.database, day)
    if not maps:
        raise InhandError(f"there is no map of {day}: nothing was swept")
    # OpenCV draws it, and no other verb of these needs it.
    from inhand.outcomes_map import draw_floor_maps

    draw_floor_maps(maps, kept.settings.regions, path)
    print(f"drawn in {path}")


_RUN = {
    "today": _show_today,
    "history": _show_history,
    "where": _show_where,
    "forget": _forget,
}
