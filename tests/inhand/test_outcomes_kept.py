"""What is kept of outcomes can be looked at and removed on the command line."""

import io
import json
import os
import subprocess
import sys
from datetime import UTC, datetime, timedelta
from pathlib import Path
from time import time_ns
from typing import Any

import cv2
import numpy as np
import pytest
from inhand_outcomes.achievement import Amount
from inhand_outcomes.days import local_day
from inhand_outcomes.floor_picture import PIXELS, SWEPT
from inhand_outcomes.store.database import Database, open_database
from inhand_outcomes.store.floor_maps import FloorMapHeader, KeptFloorMap, keep_floor_map
from inhand_outcomes.store.queries import latest
from inhand_outcomes.store.saving import Saver
from inhand_runtime.errors import InhandError, SettingsError
from kept_outcomes import KEEPING, ZURICH, S, all_totals, new_saver, sip

from inhand.__main__ import main
from inhand.outcomes_kept import ask

SETTINGS = """
[outcomes.home]
time_zone = "Europe/Zurich"
people = {0 = "anna", 1 = "ben"}

[[outcomes.home.goals]]
name = "drink"
kind = "sip"
amount = "volume_ml"
at_least = 1500
"""
TABLE = """
[[outcomes.home.regions]]
name = "under_the_table"
from = [1.0, 1.5]
to = [2.0, 1.0]
"""
PNG = b"\x89PNG"


@pytest.fixture
def config(tmp_path: Path) -> Path:
    """The settings of an instance that has kept some days up to now."""
    (tmp_path / "rig.toml").write_text(SETTINGS)
    saver = new_saver(tmp_path)
    today = local_day(time_ns(), ZURICH)
    for back in range(3):
        noon = datetime.combine(today - timedelta(days=back), datetime.min.time(), UTC)
        noon_ns = round(noon.timestamp() + 12 * 3600) * S
        sips = [sip(noon_ns + number * 60 * S, person=number % 2) for number in range(4 + back)]
        doubtful = sip(noon_ns + 3600 * S, probability=0.2, object="cup")
        steps = {"duration_s": Amount(700.0, 2.0)}
        worn = sip(noon_ns - 700 * S, kind="worn", object="glasses", amounts=steps)
        saver.save([*sips, doubtful, worn])
    saver.database.close()
    return tmp_path / "rig.toml"


def answer(config: Path, *words: str | Path) -> dict[str, Any]:
    """What a verb writes for machines."""
    file = config.with_name("answer.json")
    command = ["outcomes", *map(str, words), "--config", str(config), "--json", str(file)]
    assert main(command) == 0
    result: dict[str, Any] = json.loads(file.read_text())
    return result


def opened(config: Path) -> Database:
    return open_database(config.with_name("outcomes.db"))


def test_today_shows_totals_goals_and_what_was_last(
    config: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    result = answer(config, "today")
    by_person = {row["name"]: row for row in result["totals"] if row["object"] == "mug"}
    assert by_person["anna"]["times"] == by_person["ben"]["times"] == 2
    assert by_person["anna"]["amounts"] == {"angle_deg": 50.0, "volume_ml": 40.0}
    assert by_person["anna"]["deviations"]["volume_ml"] == pytest.approx(32**0.5)
    (goal,) = result["goals"]
    assert (goal["goal"], goal["value"], goal["at_least"]) == ("drink", 80.0, 1500.0)
    assert [row["counted"] for row in result["latest"]].count(False) == 1
    printed = capsys.readouterr().out
    assert "volume 40 ± 5.66 ml" in printed
    assert "duration 11 min 40 s ± 2.0 s" in printed
    assert "uncertain, not counted" in printed


def test_history_shows_days_in_order_and_draws_them(
    config: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    picture = config.with_name("week.png")
    result = answer(config, "history", "--days", "3", "--plot", picture)
    days = [row["day"] for row in result["totals"]]
    assert days == sorted(days)
    assert (days[0], days[-1]) == (result["first"], result["last"])
    assert len(set(days)) == 3
    assert picture.read_bytes().startswith(PNG)
    assert "cup" not in capsys.readouterr().out  # uncertain
    assert answer(config, "history", "--days", "1")["first"] == result["last"]


def test_where_says_where_a_thing_was_last(
    config: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    result = answer(config, "where", "glasses")
    assert result["rig_from_object"]["translation"] == [0.25, -0.5, 2.0]
    printed = capsys.readouterr().out
    assert "glasses: 2.00 m before the rig, 0.25 m to its right, 0.50 m above it" in printed
    assert "(worn, anna)" in printed
    with pytest.raises(InhandError, match=r"did you mean glasses\?"):
        ask(["where", "glases", "--config", str(config)])
    with pytest.raises(InhandError, match=r"m\\x1b\[2Jug was seen nowhere"):
        ask(["where", "m\x1b[2Jug", "--config", str(config)])


def test_a_person_is_forgotten_by_name_while_a_daemon_keeps_the_database_open(
    config: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    daemon = Saver(opened(config), KEEPING)
    daemon.save([], {"state": b"1"})
    result = answer(config, "forget", "ben", "--yes")
    assert result["removed"]["outcomes"] == 2 + 2 + 3
    assert "removed all of person 1 (ben): 7 outcomes, 3 totals of days" in capsys.readouterr().out
    assert {one.person for one in all_totals(daemon.database)} == {0}
    assert daemon.save([], {"state": b"2"}).forget
    daemon.database.close()


def test_a_day_and_all_are_forgotten(config: Path) -> None:
    today = local_day(time_ns(), ZURICH)
    answer(config, "forget", "--day", today.isoformat(), "--yes")
    database = opened(config)
    assert max(one.day for one in all_totals(database)) < today
    answer(config, "forget", "--all", "--yes")
    assert all_totals(database) == latest(database, 9) == []
    database.close()


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (("forget", "0"), "add --yes"),
        (("forget", "bne", "--yes"), r"nobody is named 'bne' \(did you mean ben\?\)"),
        (("forget", "--day", "yesterday", "--yes"), "'yesterday' is no day"),
    ],
)
def test_nothing_is_forgotten_by_a_mistake(
    config: Path, words: tuple[str, ...], line: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO())
    before = all_totals(database := opened(config))
    with pytest.raises(SettingsError, match=line):
        ask([*words, "--config", str(config)])
    assert all_totals(database) == before
    database.close()


@pytest.mark.long
@pytest.mark.parametrize(("typed", "code", "left"), [("no", 1, True), ("yes", 0, False)])
def test_a_terminal_is_asked_first(config: Path, typed: str, code: int, left: bool) -> None:
    typing, terminal = os.openpty()
    program = (
        "import sys; from inhand.outcomes_kept import ask\n"
        "from inhand_runtime.errors import InhandError\n"
        "try: ask(sys.argv[1:])\nexcept InhandError as error: sys.exit(str(error))"
    )
    command = [sys.executable, "-c", program, "forget", "--all", "--config", str(config)]
    os.write(typing, f"{typed}\n".encode())
    done = subprocess.run(command, stdin=terminal, capture_output=True, text=True, timeout=120)
    os.close(typing)
    os.close(terminal)
    assert done.returncode == code
    assert f"Remove all that is kept from {config.with_name('outcomes.db')}?" in done.stdout
    assert ("nothing was removed" in done.stderr) == left
    database = opened(config)
    assert bool(all_totals(database)) == left
    database.close()


def test_the_map_of_today_is_drawn(config: Path) -> None:
    with pytest.raises(InhandError, match="nothing was swept"):
        ask(["today", "--map", str(config.with_name("floor.png")), "--config", str(config)])
    database, today = opened(config), local_day(time_ns(), ZURICH)
    header = FloorMapHeader(0.05, -2.0, 0.0, 60, 80)
    for person, columns in ((0, slice(10, 40)), (1, slice(40, 70))):
        cells = np.full((60, 80), 1 << 5, np.uint8)  # floor
        cells[20:40, columns] |= 31  # surely swept
        keep_floor_map(database, KeptFloorMap(today, "broom", person, header, cells))
    database.close()
    answer(config, "today", "--map", config.with_name("floor.png"))
    picture = cv2.imread(str(config.with_name("floor.png")))
    assert picture is not None
    # The table reaches from 0.5 m beyond what was swept to 0.5 m within it, all of the floor.
    with config.open("a") as settings:
        settings.write(TABLE)
    (region,) = answer(config, "today", "--map", config.with_name("table.png"))["regions"]
    assert region["region"] == "under_the_table"
    assert region["share"] == pytest.approx(0.5, abs=0.01)
    assert (region["swept_m2"], region["missed_m2"]) == pytest.approx((0.25, 0.25))
    assert config.with_name("table.png").read_bytes() != config.with_name("floor.png").read_bytes()
    # Both swept 600 of the cells of 5 cm, which are drawn eight pixels wide.
    swept = (picture[: 60 * PIXELS] == SWEPT).all(axis=2)
    assert swept.sum() == 2 * 600 * PIXELS**2


def test_where_nothing_was_kept_it_is_said_and_nothing_is_made(tmp_path: Path) -> None:
    (tmp_path / "rig.toml").write_text(SETTINGS)
    with pytest.raises(InhandError, match=r"nothing was kept yet: there is no .*outcomes\.db"):
        ask(["today", "--config", str(tmp_path / "rig.toml")])
    assert [file.name for file in tmp_path.iterdir()] == ["rig.toml"]
