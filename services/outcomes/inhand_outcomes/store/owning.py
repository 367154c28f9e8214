"""A database has one owner, which alone adds to it: for as long as its process lives, however it
ends."""

import fcntl
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Protocol

from inhand_runtime.private_file import PRIVATE_FILE
from sqlalchemy import Connection, Engine, text

from inhand_outcomes.store.failures import StoreError

OWNERS_LOCK = 0x1A4A110
"""Number of the lock that an owner of a database of PostgreSQL holds."""
BESIDE = "-owner"
"""End of the name of the file that the owner of a file of SQLite holds."""
LOST_AFTER = "SET tcp_keepalives_idle = 30; SET tcp_keepalives_interval = 10; "
LOST_AFTER += "SET tcp_keepalives_count = 3"
"""PostgreSQL gives up the lock of a host that is gone after a minute, not after two hours."""


class TakenError(StoreError):
    """Another daemon owns the database."""


class Claim(Protocol):
    """A database that is owned."""

    def check(self) -> None:
        """Raise SQLAlchemyError where it is owned no more."""

    def release(self) -> None:
        """Let another own it."""


@dataclass(frozen=True)
class FileClaim:
    """A file of SQLite: the file beside it is locked, which ends with the process."""

    lock: IO[str]

    def check(self) -> None:
        """A lock of a file is never lost."""

    def release(self) -> None:
        """Unlock it."""
        self.lock.close()


@dataclass(frozen=True)
class SessionClaim:
    """A database of PostgreSQL: a session of its own holds a lock, and the server ends both when
    the process ends."""

    engine: Engine
    connection: Connection

    def check(self) -> None:
        """See that the session lives."""
        self.connection.execute(text("SELECT 1"))

    def release(self) -> None:
        """End the session."""
        self.connection.close()
        self.engine.dispose()


def claim_file(file: Path, owner: str) -> FileClaim:
    """Own a file of SQLite; raises TakenError where another does, StoreError where it cannot be
    said."""
    path = file.with_name(file.name + BESIDE)
    try:
        path.touch(PRIVATE_FILE)
        lock = path.open("r+", encoding="utf-8")
    except OSError as error:
        raise StoreError(f"the database {file}: {path} cannot be made: {error.strerror}") from None
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        other = lock.read()
        lock.close()
        raise _taken(str(file), other) from None
    except OSError as error:
        lock.close()
        raise StoreError(f"the database {file}: {path} cannot be locked: {error}") from None
    lock.truncate()
    lock.write(owner)
    lock.flush()
    return FileClaim(lock)


def claim_session(engine: Engine, name: str, owner: str) -> SessionClaim:
    """Own a database of PostgreSQL by an engine that is for this alone; raises TakenError where
    another does, and SQLAlchemyError."""
    connection = engine.connect().execution_options(isolation_level="AUTOCOMMIT")
    claim = SessionClaim(engine, connection)
    try:
        connection.execute(text(LOST_AFTER))
        named = {"owner": owner}
        connection.execute(text("SELECT set_config('application_name', :owner, false)"), named)
        if connection.scalar(text(f"SELECT pg_try_advisory_lock({OWNERS_LOCK})")):
            return claim
        other = connection.scalar(text(_WHO))
    except BaseException:
        claim.release()
        raise
    claim.release()
    raise _taken(name, other or "")


_WHO = f"""
SELECT application_name FROM pg_stat_activity JOIN pg_locks USING (pid)
WHERE locktype = 'advisory' AND granted AND objid = {OWNERS_LOCK}
AND pg_locks.database = (SELECT oid FROM pg_database WHERE datname = current_database())
"""


def _taken(name: str, other: str) -> TakenError:
    return TakenError(
        f"the database {name} belongs to another daemon, {other or 'of no name'}: end that, or "
        "give each instance a database of its own"
    )
