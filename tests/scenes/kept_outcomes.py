"""Outcomes to be kept, and a database of SQLite to keep them in."""

from datetime import date, datetime
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from zoneinfo import ZoneInfo

from inhand_outcomes.achievement import Amount
from inhand_outcomes.outcome import Outcome, outcome_id
from inhand_outcomes.store.database import Database, open_database
from inhand_outcomes.store.queries import days_kept, totals
from inhand_outcomes.store.saving import Keeping, Saver
from inhand_outcomes.totals import DayTotal
from inhand_schemas.messages import Pose

ZURICH = ZoneInfo("Europe/Zurich")
KEEPING = Keeping(ZURICH)
S = 1_000_000_000


def at(text: str, zone: ZoneInfo = ZURICH) -> int:
    """Nanoseconds since the epoch of a local time, ``2026-03-29 01:30``."""
    return round(datetime.fromisoformat(text).replace(tzinfo=zone).timestamp()) * S


def sip(end_ns: int, ml: float = 20.0, **changes: Any) -> Outcome:
    """A sip of two seconds by person 0 from the mug, unless ``changes`` say otherwise."""
    values: dict[str, Any] = {
        "kind": "sip",
        "object": "mug",
        "person": 0,
        "start_ns": end_ns - 2 * S,
        "end_ns": end_ns,
        "probability": 0.9,
        "amounts": {"volume_ml": Amount(ml, 4.0), "angle_deg": Amount(50.0, 3.0)},
        "evidence": {"mouth_m": 0.0312345678, "tilt_deg": 52.25},
        "rig_from_object": Pose((0.25, -0.5, 2.0), (1.0, 0.0, 0.0, 0.0)),
        "first_sequence": 7,
        "last_sequence": 67,
        **changes,
    }
    key = (values[name] for name in ("kind", "object", "person", "start_ns"))
    return Outcome(**{"id": outcome_id("kitchen", *key), **values})


@cache
def _new_file() -> bytes:
    """A database with nothing in it: making its tables takes longer than most tests."""
    with TemporaryDirectory() as folder:
        open_database(file := Path(folder) / "new.db").close()
        return file.read_bytes()


def new_saver(folder: Path, keeping: Keeping = KEEPING) -> Saver:
    """Open ``outcomes.db`` in a folder, which is made with nothing in it where there is none."""
    if not (file := folder / "outcomes.db").exists():
        file.write_bytes(_new_file())
    return Saver(open_database(folder / "outcomes.db"), keeping)


def all_totals(database: Database) -> list[DayTotal]:
    """The totals of all days."""
    return totals(database, *(days_kept(database) or (date.min, date.min)))
