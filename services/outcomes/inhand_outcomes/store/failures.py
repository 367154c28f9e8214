"""What a database fails at, in one line that says the mend."""

from collections.abc import Iterator
from contextlib import contextmanager

from inhand_runtime.errors import InhandError
from sqlalchemy.exc import DBAPIError, SQLAlchemyError

_MENDS = (
    ("disk is full", "the disk is full: make room; what is new waits in memory"),
    ("no space left", "the disk is full: make room; what is new waits in memory"),
    ("lock timeout", "another process holds it for long: end that, or wait"),
    ("locked", "another process holds it for long: end that, or wait"),
    ("not a database", "the file is no database of SQLite: name another, or move it away"),
    ("malformed", "the file is damaged: move it away, and put back a copy, or begin anew"),
    ("readonly", "it cannot be written: let this user write the file and its folder"),
    ("read-only", "it cannot be written: let this user write the file and its folder"),
    ("unable to open", "it cannot be opened: let this user read and write the file's folder"),
    ("disk i/o error", "the disk cannot be read or written: look at the disk"),
    ("password", "it does not let this user in: look at the user and at password_file"),
    ("already exists", "tables of another program are in it: name another database"),
    ("does not exist", "it is not there: make it with createdb, or look at the address"),
    ("connection", "it cannot be reached: see that it runs, and look at the address"),
)
"""Parts of what databases say, in small letters, and what is to be done."""


class StoreError(InhandError):
    """The database cannot be read or written now; nothing of what was asked for was done."""


@contextmanager
def explained(database: str) -> Iterator[None]:
    """Raise StoreError for what a database of this name fails at within the block."""
    try:
        yield
    except SQLAlchemyError as error:
        raise StoreError(_line(database, error)) from error


def _line(database: str, error: SQLAlchemyError) -> str:
    cause = error.orig if isinstance(error, DBAPIError) and error.orig is not None else error
    said = str(cause).strip().splitlines() or [type(cause).__name__]
    text = " ".join(said).lower()
    mend = next((mend for part, mend in _MENDS if part in text), said[0])
    return f"the database {database}: {mend}"
