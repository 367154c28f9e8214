"""An open database: SQLite by its file, PostgreSQL by its address."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, Engine, create_engine, event, text
from sqlalchemy.engine import URL, make_url
from sqlalchemy.exc import ArgumentError
from sqlalchemy.orm import Session

from inhand_outcomes.store.failures import explained
from inhand_outcomes.store.migrating import migrate
from inhand_outcomes.store.owning import Claim, claim_file, claim_session
from inhand_outcomes.store.parameters import DEFAULT_STORE, StoreParameters

WRITERS_LOCK = 0x1A4A11D
"""Number of the lock by which writers of one database of PostgreSQL take turns."""


@dataclass(frozen=True)
class Database:
    """A database whose tables are as this release has them."""

    engine: Engine
    name: str
    """The file, or the address without its password."""
    claim: Claim | None = None
    """What its owner has of it, None for those that look at it, or remove some of it."""

    @contextmanager
    def reading(self) -> Iterator[Session]:
        """Look at one state of the database; raises StoreError."""
        with explained(self.name), Session(self.engine) as session:
            yield session

    @contextmanager
    def writing(self, *, durable: bool = True) -> Iterator[Session]:
        """Change all that the block changes, or nothing; writers take turns. Raises StoreError.

        What is not ``durable`` survives the end of any process, but perhaps not of the power.
        """
        with explained(self.name), _writer(self.engine, durable=durable) as connection:
            if self.claim is not None:
                self.claim.check()
            session = Session(connection, expire_on_commit=False)
            yield session
            session.flush()

    def close(self) -> None:
        """Give back its files and connections."""
        self.engine.dispose()
        if self.claim is not None:
            self.claim.release()


def open_database(
    place: Path | str,
    password: str | None = None,
    parameters: StoreParameters = DEFAULT_STORE,
    owner: str | None = None,
) -> Database:
    """Open a file of SQLite, which is made where there is none, or ``postgresql+psycopg://…``.

    Its tables are brought to the form of this release, all or nothing. Whoever adds to it names
    itself as its ``owner``, until the database is closed. Raises StoreError, also for a database of
    a later release, and TakenError where it has another owner.
    """
    url = _url(place, password)
    sqlite = url.get_backend_name() == "sqlite"
    name = str(place) if sqlite else url.set(password=None).render_as_string()
    with explained(name):
        engine = _sqlite(url, parameters) if sqlite else _postgresql(url, parameters)
    database = Database(engine, name)
    try:
        with explained(name):
            if owner is not None:
                database = Database(engine, name, _claim(place, url, name, parameters, owner))
            migrate(engine, partial(_writer, engine), name)
    except BaseException:
        database.close()
        raise
    return database


def readable_address(text: str) -> bool:
    """Whether ``open_database`` can read an address of PostgreSQL."""
    try:
        make_url(text)
    except (ArgumentError, ValueError):  # of a port that is no number
        return False
    return True


def _claim(
    place: Path | str, url: URL, name: str, parameters: StoreParameters, owner: str
) -> Claim:
    if isinstance(place, Path):
        return claim_file(place, owner)
    return claim_session(_postgresql(url, parameters), name, owner)


@contextmanager
def _writer(engine: Engine, *, durable: bool = True) -> Iterator[Connection]:
    """A transaction of which there is one at a time."""
    options = {"inhand_writes": True, "inhand_durable": durable}
    with engine.connect().execution_options(**options) as connection, connection.begin():
        if engine.dialect.name == "postgresql":
            connection.execute(text(f"SELECT pg_advisory_xact_lock({WRITERS_LOCK})"))
        yield connection


def _url(place: Path | str, password: str | None) -> URL:
    if isinstance(place, Path):
        return URL.create("sqlite", database=str(place))
    url = make_url(place)
    return url if password is None else url.set(password=password)


def _postgresql(url: URL, parameters: StoreParameters) -> Engine:
    seconds = parameters.patience_s
    waits = {"connect_timeout": round(seconds), "options": f"-c lock_timeout={seconds * 1e3:.0f}"}
    return create_engine(
        url, connect_args=waits, pool_pre_ping=True, json_serializer=_compact, pool_size=1
    )


def _sqlite(url: URL, parameters: StoreParameters) -> Engine:
    # The driver begins no transaction by itself: SQLAlchemy's events below do.
    engine = create_engine(
        url,
        connect_args={"timeout": parameters.patience_s, "isolation_level": None},
        json_serializer=_compact,
    )

    @event.listens_for(engine, "connect")
    def prepare(connection: Any, _: object) -> None:
        for pragma in (
            "foreign_keys = ON",
            "secure_delete = ON",
            f"journal_size_limit = {parameters.log_bytes}",
            f"cache_size = -{parameters.cache_kib}",
        ):
            connection.execute(f"PRAGMA {pragma}")
        _use_log(connection)

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        options = connection.get_execution_options()
        if options.get("inhand_bare", False):
            return
        if not options.get("inhand_writes", False):
            connection.exec_driver_sql("BEGIN")
            return
        level = "FULL" if options["inhand_durable"] else "NORMAL"
        connection.exec_driver_sql(f"PRAGMA synchronous = {level}")
        connection.exec_driver_sql("BEGIN IMMEDIATE")

    return engine


def _use_log(connection: Any) -> None:
    """Let readers and the writer of a file not wait for each other."""
    if connection.execute("PRAGMA journal_mode").fetchone()[0] != "wal":
        connection.execute("PRAGMA journal_mode = WAL")


_compact = partial(json.dumps, separators=(",", ":"), allow_nan=False)
