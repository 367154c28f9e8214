"""A real PostgreSQL keeps outcomes as SQLite does."""

import subprocess
import sys
from collections.abc import Iterator
from datetime import date
from pathlib import Path

import numpy as np
import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from inhand_outcomes.rules import Goal, PersonsGoal, Rules
from inhand_outcomes.store.database import Database, open_database
from inhand_outcomes.store.failures import StoreError
from inhand_outcomes.store.floor_maps import (
    FloorMapHeader,
    KeptFloorMap,
    floor_maps,
    keep_floor_map,
)
from inhand_outcomes.store.forgetting import Forget, forget
from inhand_outcomes.store.goal_marks import events_to_publish, judge_goals
from inhand_outcomes.store.models import Base
from inhand_outcomes.store.owning import OWNERS_LOCK, TakenError
from inhand_outcomes.store.parameters import StoreParameters
from inhand_outcomes.store.queries import last_places, latest
from inhand_outcomes.store.retention import Retention, remove_old
from inhand_outcomes.store.saving import Saver, read_journal
from kept_outcomes import KEEPING, ZURICH, S, all_totals, at, new_saver, sip
from postgresql import postgresql
from sqlalchemy import text

pytestmark = pytest.mark.long

NOON = at("2026-05-05 12:00")
SAVING = """
import sys
sys.path[:0] = sys.argv[2:]
from kept_outcomes import KEEPING, S, at, sip
from inhand_outcomes.store.database import open_database
from inhand_outcomes.store.saving import Saver
saver = Saver(open_database(sys.argv[1]), KEEPING)
for number in range(30):
    saver.save([sip(at("2026-05-05 12:00") + number * 10 * S)])
"""


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with postgresql() as running:
        yield running


@pytest.fixture
def database(address: str) -> Iterator[Database]:
    """One with nothing in it."""
    opened = open_database(address)
    yield opened
    with opened.engine.begin() as connection:
        connection.execute(text("DROP SCHEMA public CASCADE"))
        connection.execute(text("CREATE SCHEMA public"))
    opened.close()


def test_it_answers_as_sqlite_does(database: Database, tmp_path: Path) -> None:
    outcomes = [sip(NOON + 10 * number * S, person=number % 3 or None) for number in range(9)]
    outcomes.append(sip(NOON + S, person=None))
    answers = []
    for one in (database, new_saver(tmp_path).database):
        saver = Saver(one, KEEPING)
        saved = saver.save(outcomes, {"state": b"\x00\xff"})
        goal = Goal(name="drink", kind="sip", at_least=5)
        judge_goals(one, Rules([PersonsGoal(goal, None)], ZURICH), NOON + 3600 * S)
        answers.append(
            (saved, all_totals(one), latest(one, 99), last_places(one), events_to_publish(one))
        )
        assert read_journal(one) == {"state": b"\x00\xff"}
        assert remove_old(one, Retention(1, 2), date(2026, 5, 7)) == 9
    assert answers[0] == answers[1]
    assert len(answers[0][0].known) == 1


def test_its_tables_are_those_of_the_models(database: Database) -> None:
    with database.engine.connect() as connection:
        assert compare_metadata(MigrationContext.configure(connection), Base.metadata) == []


def test_what_is_forgotten_is_gone(database: Database) -> None:
    saver = Saver(database, KEEPING)
    saver.save([sip(NOON), sip(NOON, person=1)], {"state": b"1"})
    header = FloorMapHeader(0.05, 0.0, 0.0, 2, 3)
    for person in (0, 1):
        cells = np.ones((2, 3), np.uint8)
        keep_floor_map(database, KeptFloorMap(date(2026, 5, 5), "broom", person, header, cells))
    removed = forget(database, Forget(person=1), NOON + S)
    assert (removed.outcomes, removed.floor_maps) == (1, 1)
    assert [one.person for one in all_totals(database)] == [0]
    assert [one.person for one in floor_maps(database, date(2026, 5, 5))] == [0]
    assert saver.save([sip(NOON, person=1)]).forget


def test_two_that_save_the_same_acts_keep_each_once(database: Database, address: str) -> None:
    command = [sys.executable, "-c", SAVING, address, *sys.path]
    running = [subprocess.Popen(command) for _ in range(2)]
    assert [one.wait(120) for one in running] == [0, 0]
    assert len(latest(database, 999)) == 30
    assert [one.times for one in all_totals(database)] == [30]


def test_a_database_of_a_later_release_is_refused(database: Database, address: str) -> None:
    with database.engine.begin() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    with pytest.raises(StoreError, match="is of a later release"):
        open_database(address)


def test_what_fails_is_one_line_without_a_password(address: str, database: Database) -> None:
    with pytest.raises(StoreError, match="is not there") as caught:
        open_database(address.replace("/postgres?", "/none?"), "secret")
    assert "secret" not in str(caught.value)
    with pytest.raises(StoreError, match="cannot be reached"):
        open_database("postgresql+psycopg://nobody@127.0.0.1:9/none")
    impatient = open_database(address, parameters=StoreParameters(patience_s=1.0))
    with (
        database.writing(),
        pytest.raises(StoreError, match="another process holds it"),
        impatient.writing(),
    ):
        pass
    impatient.close()


def test_it_has_one_owner_until_its_session_ends(database: Database, address: str) -> None:
    mine = open_database(address, owner="outcomes home of inhand/rig")
    with pytest.raises(TakenError, match="another daemon, outcomes home of inhand/rig: end"):
        open_database(address, owner="shed")
    with database.engine.begin() as connection:  # as where the owner's host is gone
        end = f"SELECT pg_terminate_backend(pid) FROM pg_locks WHERE objid = {OWNERS_LOCK}"
        assert connection.execute(text(end)).all() == [(True,)]
    other = open_database(address, owner="shed")
    with pytest.raises(StoreError), mine.writing():
        pass
    with other.writing():
        pass
    mine.close()
    other.close()


def test_a_connection_that_ended_is_made_again(database: Database, address: str) -> None:
    saver = Saver(database, KEEPING)
    saver.save([sip(NOON)])
    other = open_database(address)
    with other.engine.begin() as connection:
        others = "pid <> pg_backend_pid() AND datname = current_database()"
        end = f"SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE {others}"
        assert connection.execute(text(end)).all() == [(True,)]
    other.close()
    assert saver.save([sip(NOON)]).known
