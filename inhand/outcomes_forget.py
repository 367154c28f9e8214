"""Removes what is kept of a person, of a day, or all, once whoever asks is sure."""

import argparse
import sys
from datetime import date
from time import time_ns
from typing import Any

import msgspec
from inhand_outcomes.keeping import KeepingSettings, person_number
from inhand_outcomes.store.database import Database
from inhand_outcomes.store.forgetting import Forget, Removed, forget
from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.wording import counted


def add_forget(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``forget``."""
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("person", nargs="?", metavar="PERSON", help="a number, or a name of people")
    what.add_argument("--day", metavar="DATE", help="a local day, as 2026-03-29")
    what.add_argument("--all", action="store_true", help="all that is kept")
    parser.add_argument("--yes", action="store_true", help="do not ask first")


def forget_kept(
    database: Database, settings: KeepingSettings, arguments: argparse.Namespace
) -> dict[str, Any]:
    """Forget what the arguments name, and say what that removed; raises SettingsError, and
    InhandError where it is not done."""
    what, words = _chosen(settings, arguments)
    if not arguments.yes:
        _make_sure(words, database.name)
    removed = forget(database, what, time_ns())
    print(f"removed {words}: {_text(removed)}")
    return {"removed": msgspec.to_builtins(removed)}


def _chosen(settings: KeepingSettings, arguments: argparse.Namespace) -> tuple[Forget, str]:
    if arguments.all:
        return Forget(everything=True), "all that is kept"
    if arguments.day is not None:
        day = _day(arguments.day)
        return Forget(day=day), f"all of {day}"
    try:
        person = person_number(arguments.person, settings.people)
    except ValueError as error:
        raise SettingsError(str(error)) from None
    name = settings.people.get(person)
    return Forget(person=person), f"all of person {person}" + (f" ({name})" if name else "")


def _day(text: str) -> date:
    try:
        return date.fromisoformat(text)
    except ValueError:
        raise SettingsError(f"{text!r} is no day: write it as 2026-03-29") from None


def _make_sure(words: str, database: str) -> None:
    if not sys.stdin.isatty():
        raise SettingsError("forgetting asks first at a terminal: add --yes")
    if input(f"Remove {words} from {database}? It cannot be undone. (yes/no): ").strip() != "yes":
        raise InhandError("nothing was removed")


def _text(removed: Removed) -> str:
    return ", ".join(
        counted(number, one, many)
        for number, one, many in (
            (removed.outcomes, "outcome", "outcomes"),
            (removed.totals, "total of a day", "totals of days"),
            (removed.places, "place of an object", "places of objects"),
            (removed.floor_maps, "map of the floor", "maps of the floor"),
            (removed.goals, "note of a goal", "notes of goals"),
        )
    )
