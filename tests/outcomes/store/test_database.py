"""Databases are opened, migrated, and say in one line what is wrong with them."""

import os
import sqlite3
import stat
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from inhand_outcomes.keeping import KeepingSettings, open_kept
from inhand_outcomes.store import migrating
from inhand_outcomes.store.database import open_database
from inhand_outcomes.store.failures import StoreError
from inhand_outcomes.store.models import Base
from inhand_outcomes.store.owning import TakenError
from inhand_outcomes.store.parameters import StoreParameters
from inhand_outcomes.store.queries import latest, outcomes_to_publish
from kept_outcomes import at, new_saver, sip

FULL_DISK = """
import subprocess, sys
from pathlib import Path
sys.path[:0] = sys.argv[2:]
from kept_outcomes import S, at, new_saver, sip
from inhand_outcomes.store.failures import StoreError
from inhand_outcomes.store.queries import latest
saver = new_saver(Path(sys.argv[1]))
first = saver.save([sip(at("2026-05-05 12:00"))])
try:
    for batch in range(100):
        times = [at("2026-05-05 13:00") + (100 * batch + one) * 10 * S for one in range(100)]
        saver.save([sip(time) for time in times], {"state": bytes(100_000)})
except StoreError as error:
    print(error)
    print(len(latest(saver.database, 10**6)) == 1 + 100 * batch)
saver.database.close()
subprocess.run(["mount", "-o", "remount,ro", sys.argv[1]], check=True)
try:
    new_saver(Path(sys.argv[1])).save([sip(at("2026-05-06 12:00"))])
except StoreError as error:
    print(error)
"""
OWN_DISK = 'mount -t tmpfs -o size=1m none "$0" && exec "$@"'


def test_the_newest_migration_makes_the_tables_of_the_models(tmp_path: Path) -> None:
    database = open_database(tmp_path / "a.db")
    with database.engine.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        assert compare_metadata(context, Base.metadata) == []
        assert context.get_current_revision() == migrating.HEAD
    config = Config()
    config.set_main_option("script_location", str(migrating.MIGRATIONS))
    config.set_main_option("path_separator", "os")
    assert ScriptDirectory.from_config(config).get_heads() == [migrating.HEAD]
    database.close()


def test_a_database_of_a_later_release_is_refused_and_left_as_it_is(tmp_path: Path) -> None:
    file = tmp_path / "outcomes.db"
    new_saver(tmp_path).database.close()
    _sql(file, "UPDATE alembic_version SET version_num = '9999'")
    before = file.read_bytes()
    with pytest.raises(StoreError, match=r"outcomes\.db is of a later release .*: update Inhand"):
        open_database(file)
    assert file.read_bytes() == before


def test_what_an_earlier_release_kept_is_not_published_again(tmp_path: Path) -> None:
    saver = new_saver(tmp_path)
    saver.save([sip(at("2026-05-05 12:00"))])
    saver.database.close()
    file = tmp_path / "outcomes.db"
    _sql(file, "DROP INDEX ix_outcomes_published")
    _sql(file, "ALTER TABLE outcomes DROP COLUMN published")
    _sql(file, "UPDATE alembic_version SET version_num = '0001'")
    database = open_database(file)
    assert len(latest(database, 9)) == 1
    assert outcomes_to_publish(database, 9) == []
    database.close()


def test_a_migration_that_ends_half_way_is_begun_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "a.db"
    steps = tmp_path / "migrations"
    for path in migrating.MIGRATIONS.rglob("*.py"):
        copy = steps / path.relative_to(migrating.MIGRATIONS)
        copy.parent.mkdir(parents=True, exist_ok=True)
        text = path.read_text()
        copy.write_text(
            text.replace(
                'op.create_table(\n        "totals"',
                'raise OSError("cut")\n    op.create_table(\n        "totals"',
            )
        )
    with monkeypatch.context() as patched:
        patched.setattr(migrating, "MIGRATIONS", steps)
        with pytest.raises(OSError, match="cut"):
            open_database(file)
    assert _sql(file, "SELECT name FROM sqlite_master") == []
    open_database(file).close()
    assert ("totals",) in _sql(file, "SELECT name FROM sqlite_master")


def test_a_database_has_one_owner_and_whoever_looks(tmp_path: Path) -> None:
    file = tmp_path / "outcomes.db"
    mine = open_database(file, owner="home")
    with pytest.raises(TakenError, match=r"outcomes\.db belongs to another daemon, home: end that"):
        open_database(file, owner="shed")
    looking = open_database(file)
    assert latest(looking, 1) == []
    looking.close()
    mine.close()
    open_database(file, owner="shed").close()


def test_an_owner_that_is_killed_owns_nothing(tmp_path: Path) -> None:
    file = tmp_path / "outcomes.db"
    program = (
        "import sys, time; from pathlib import Path\n"
        "from inhand_outcomes.store.database import open_database\n"
        "mine = open_database(Path(sys.argv[1]), owner='killed')\n"
        "print('owns', flush=True); time.sleep(600)"
    )
    command = [sys.executable, "-c", program, file]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == b"owns\n"
        with pytest.raises(TakenError, match="killed"):
            open_database(file, owner="next")
        other.kill()
    open_database(file, owner="next").close()


@pytest.mark.long
def test_two_processes_may_open_a_new_database_at_once(tmp_path: Path) -> None:
    program = (
        "import sys; from pathlib import Path\n"
        "from inhand_outcomes.store.database import open_database\n"
        "sys.stdin.readline(); open_database(Path(sys.argv[1])).close()"
    )
    command = [sys.executable, "-c", program, tmp_path / "a.db"]
    running = [subprocess.Popen(command, stdin=subprocess.PIPE) for _ in range(3)]
    for one in running:
        one.communicate(b"\n", timeout=60)
    assert [one.returncode for one in running] == [0, 0, 0]


def test_others_may_not_read_the_file(tmp_path: Path) -> None:
    file = tmp_path / "new" / "outcomes.db"
    with_kept = open_kept(KeepingSettings(database=str(file)))
    with with_kept.writing():
        modes = {stat.S_IMODE(path.stat().st_mode) for path in file.parent.iterdir()}
    assert modes == {0o600}
    with_kept.close()


@pytest.mark.parametrize(
    ("content", "line"),
    [
        (b"no database, but a text of some length" * 100, "is no database of SQLite"),
        (None, "the file is damaged"),
    ],
)
def test_a_damaged_file_is_named_with_the_mend(
    tmp_path: Path, content: bytes | None, line: str
) -> None:
    saver = new_saver(tmp_path)
    saver.save([sip(at("2026-05-05 12:00"))])
    saver.database.close()
    file = tmp_path / "outcomes.db"
    data = file.read_bytes()
    file.write_bytes(content or data[:4096] + os.urandom(len(data) - 4096))
    with pytest.raises(StoreError, match=line) as caught:
        latest(open_database(file), 1)
    assert str(file) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_database_of_another_program_is_left_alone(tmp_path: Path) -> None:
    with closing(sqlite3.connect(tmp_path / "other.db")) as other:
        other.execute("CREATE TABLE outcomes (theirs INTEGER)")
    with pytest.raises(StoreError, match="tables of another program are in it: name another"):
        open_database(tmp_path / "other.db")
    with closing(sqlite3.connect(tmp_path / "other.db")) as other:
        assert other.execute("SELECT name FROM sqlite_master").fetchall() == [("outcomes",)]


def test_a_database_that_another_holds_is_said_to_be_held(tmp_path: Path) -> None:
    new_saver(tmp_path).database.close()
    database = open_database(tmp_path / "outcomes.db", parameters=StoreParameters(patience_s=0.05))
    other = sqlite3.connect(tmp_path / "outcomes.db", isolation_level=None)
    other.execute("BEGIN IMMEDIATE")
    with pytest.raises(StoreError, match="another process holds it"), database.writing():
        pass
    assert latest(database, 1) == []  # reading goes on
    other.close()
    database.close()


def test_a_folder_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match=r"database /proc/a\.db cannot be made"):
        open_kept(KeepingSettings(database="/proc/a.db"))
    (tmp_path / "outcomes.db").mkdir()
    with pytest.raises(StoreError, match="cannot be opened"):
        open_database(tmp_path / "outcomes.db")


@pytest.mark.long
def test_a_full_disk_keeps_what_it_has_and_so_does_one_that_is_read_only(tmp_path: Path) -> None:
    unshared = ("unshare", "--map-root-user", "--mount", "sh", "-c", OWN_DISK, tmp_path)
    if subprocess.run([*unshared, "true"], capture_output=True).returncode:
        pytest.skip("this user may mount nothing, not even in a namespace of its own")
    program = [sys.executable, "-c", FULL_DISK, tmp_path, *sys.path]
    done = subprocess.run([*unshared, *program], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    full, all_there, read_only = done.stdout.splitlines()
    assert "the disk is full: make room" in full
    assert all_there == "True"
    assert "cannot be written: let this user write the file" in read_only


def _sql(file: Path, statement: str) -> list[tuple[object, ...]]:
    connection = sqlite3.connect(file)
    with connection:
        rows = connection.execute(statement).fetchall()
    connection.close()
    return rows
