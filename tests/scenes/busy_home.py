"""A busy home: four people, 400 outcomes a day with evidence, and a map of the floor each day.

``python tests/scenes/busy_home.py DAYS`` says how large its database is.
"""

import sys
from collections.abc import Iterator
from datetime import UTC, date, datetime, timedelta
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np
from inhand_outcomes.achievement import Amount
from inhand_outcomes.days import NS_PER_S
from inhand_outcomes.outcome import Outcome, outcome_id
from inhand_outcomes.store.database import open_database
from inhand_outcomes.store.floor_maps import FloorMapHeader, KeptFloorMap, keep_floor_map
from inhand_outcomes.store.queries import totals
from inhand_outcomes.store.saving import Saver
from inhand_schemas.messages import Pose
from kept_outcomes import KEEPING
from numpy.typing import NDArray

A_DAY = 400
FIRST = date(2026, 1, 1)
NUMBERS = 16
"""Number of evidence numbers of an outcome: more than any measure has."""
KINDS = ("sip", "put_down", "taken_up", "in_use", "strike", "repetition", "stroke", "worn")


def outcomes_of(day: date, generator: np.random.Generator) -> Iterator[Outcome]:
    """The outcomes of a day from 7 to 22 o'clock, in order."""
    begin = round(datetime(day.year, day.month, day.day, 7, tzinfo=UTC).timestamp()) * NS_PER_S
    for number in range(A_DAY):
        start_ns = begin + number * 15 * 3600 * NS_PER_S // A_DAY
        kind = KINDS[number % len(KINDS)]
        person, thing = number // 7 % 4, f"thing{number % 15}"
        numbers = generator.normal(size=NUMBERS + 16)
        yield Outcome(
            id=outcome_id("kitchen", kind, thing, person, start_ns),
            kind=kind,
            object=thing,
            person=person,
            start_ns=start_ns,
            end_ns=start_ns + 2 * NS_PER_S,
            probability=float(generator.uniform()),
            amounts={
                name: Amount(100.0 * abs(float(value)), abs(float(value)))
                for name, value in zip(
                    ("volume_ml", "angle_deg", "duration_s"), numbers, strict=False
                )
            },
            evidence={f"evidence_{one}_deg": float(numbers[one]) for one in range(NUMBERS)},
            rig_from_object=_pose(numbers[-7:]),
            first_sequence=start_ns // NS_PER_S,
            last_sequence=start_ns // NS_PER_S + 60,
        )


def _pose(numbers: NDArray[np.float64]) -> Pose:
    x, y, z, *_ = numbers.tolist()
    w, i, j, k = (numbers[3:] / np.linalg.norm(numbers[3:])).tolist()
    return Pose((x, y, z), (w, i, j, k))


def kept_bytes(folder: Path, days: int) -> int:
    """Size of the database of so many days."""
    generator = np.random.default_rng(3)
    saver = Saver(open_database(folder / "busy.db"), KEEPING)
    for back in range(days):
        day = FIRST + timedelta(days=back)
        saver.save(list(outcomes_of(day, generator)), {"state": bytes(20_000)})
        swept = np.cumsum(generator.normal(size=(120, 160)), axis=1) > 0.0
        header = FloorMapHeader(0.05, -3.0, -3.0, 120, 160)
        cells = swept.astype(np.uint8)
        keep_floor_map(saver.database, KeptFloorMap(day, "broom", 0, header, cells))
    saver.database.close()
    return sum(file.stat().st_size for file in folder.iterdir())


def main() -> None:
    days = int(sys.argv[1])
    with TemporaryDirectory() as folder:
        megabytes = kept_bytes(Path(folder), days) / 1e6
        database = open_database(Path(folder) / "busy.db")
        start = perf_counter()
        found = totals(database, FIRST, FIRST + timedelta(days=days))
        seconds = perf_counter() - start
        database.close()
    print(
        f"{days} days of {A_DAY} outcomes: {megabytes:.1f} MB, {megabytes / days * 365:.0f} a year"
    )
    print(f"{len(found)} totals in {seconds:.2f} s")


if __name__ == "__main__":
    main()
