"""Brings the tables of a database to the form of this release when it is opened."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

from sqlalchemy import Connection, Engine, inspect, text

from inhand_outcomes.store.failures import StoreError

MIGRATIONS = Path(__file__).with_name("migrations")
HEAD = "0002"
"""The newest migration, so that alembic is loaded only where there is something to do."""


def migrate(
    engine: Engine, writer: Callable[[], AbstractContextManager[Connection]], name: str
) -> None:
    """Run the migrations that a database lacks in one transaction.

    Raises StoreError for a database of a later release.
    """
    with engine.connect() as connection:
        if _version(connection) == HEAD:
            return
    with writer() as connection:  # who waited for another that migrates finds it done
        if _version(connection) != HEAD:
            _upgrade(connection, name)


def _version(connection: Connection) -> str | None:
    if not inspect(connection).has_table("alembic_version"):
        return None
    return connection.execute(text("SELECT version_num FROM alembic_version")).scalar()


def _upgrade(connection: Connection, name: str) -> None:
    from alembic import command
    from alembic.config import Config
    from alembic.script import ScriptDirectory

    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS).replace("%", "%%"))
    config.set_main_option("path_separator", "os")
    config.attributes["connection"] = connection
    known = {revision.revision for revision in ScriptDirectory.from_config(config).walk_revisions()}
    version = _version(connection)
    if version is not None and version not in known:
        raise StoreError(
            f"the database {name} is of a later release of Inhand than this one: update Inhand"
        )
    command.upgrade(config, "head")
