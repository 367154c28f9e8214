"""While a database takes nothing, outcomes wait in memory, and none is lost or counted twice."""

import sqlite3
from itertools import pairwise
from pathlib import Path

from inhand_outcomes.store.database import open_database
from inhand_outcomes.store.failures import StoreError
from inhand_outcomes.store.parameters import StoreParameters, WaitingParameters
from inhand_outcomes.store.queries import latest
from inhand_outcomes.store.saving import Saver, read_journal
from inhand_outcomes.store.waiting import WaitingOutcomes
from kept_outcomes import KEEPING, S, all_totals, at, new_saver, sip

NOON = at("2026-05-05 12:00")
IMPATIENT = StoreParameters(patience_s=0.02)


def held_back(folder: Path, parameters: WaitingParameters | None = None) -> WaitingOutcomes:
    file = folder / "outcomes.db"
    new_saver(folder).database.close()
    opened = lambda: Saver(open_database(file, parameters=IMPATIENT), KEEPING)  # noqa: E731
    return WaitingOutcomes(opened, parameters or WaitingParameters())


def test_what_a_held_database_does_not_take_comes_in_later_once(tmp_path: Path) -> None:
    waiting = held_back(tmp_path)
    first, second, third = (sip(NOON + number * 10 * S) for number in range(3))
    assert waiting.save([first], {"state": b"1"}, 0.0) is not None
    other = sqlite3.connect(tmp_path / "outcomes.db", isolation_level=None)
    other.execute("BEGIN IMMEDIATE")
    assert waiting.save([second], {"state": b"2"}, 1.0) is None
    assert waiting.problem is not None
    assert "another process holds it" in waiting.problem
    assert waiting.save([first], {}, 1.5) is None  # not tried again yet
    assert waiting.waiting == 2
    other.close()
    saved = waiting.save([third], {"state": b"3"}, 2.1)
    assert saved is not None
    assert (list(saved.added), list(saved.known)) == ([second, third], [first])
    assert (waiting.problem, waiting.waiting, waiting.lost) == (None, 0, 0)
    assert waiting.saver is not None
    database = waiting.saver.database
    assert read_journal(database) == {"state": b"3"}
    assert [one.times for one in all_totals(database)] == [3]
    waiting.close()


def test_tries_come_less_often_and_never_less_often_than_a_minute() -> None:
    tries = []

    def unopened() -> Saver:
        tries.append(now)
        raise StoreError("the database is not there")

    waiting = WaitingOutcomes(unopened)
    for now in range(400):
        assert waiting.save([], {"state": b"1"}, float(now)) is None
    assert tries[:6] == [0, 1, 3, 7, 15, 31]
    assert {late - early for early, late in pairwise(tries[6:])} == {60}


def test_the_oldest_are_lost_and_counted_where_memory_is_full(tmp_path: Path) -> None:
    (tmp_path / "outcomes.db").mkdir()
    opened = lambda: Saver(open_database(tmp_path / "outcomes.db"), KEEPING)  # noqa: E731
    waiting = WaitingOutcomes(opened, WaitingParameters(most=3))
    for number in range(5):
        waiting.save([sip(NOON + number * 10 * S)], {}, float(number))
    assert (waiting.waiting, waiting.lost) == (3, 2)
    (tmp_path / "outcomes.db").rmdir()
    saved = waiting.save([], {}, 100.0)
    assert saved is not None
    assert [one.end_ns for one in saved.added] == [NOON + number * 10 * S for number in (2, 3, 4)]
    waiting.close()


def test_a_file_that_is_damaged_while_it_is_open_is_a_problem_and_no_end(tmp_path: Path) -> None:
    waiting = held_back(tmp_path)
    assert waiting.save([sip(NOON)], {}, 0.0) is not None
    waiting.close()
    good = (tmp_path / "outcomes.db").read_bytes()
    (tmp_path / "outcomes.db").write_bytes(b"damaged" * 1000)
    assert waiting.save([sip(NOON + 10 * S)], {}, 1.0) is None
    assert waiting.problem is not None
    assert "is no database" in waiting.problem
    (tmp_path / "outcomes.db").write_bytes(good)
    assert waiting.save([], {}, 9.0) is not None
    assert waiting.saver is not None
    assert len(latest(waiting.saver.database, 9)) == 2
    waiting.close()
