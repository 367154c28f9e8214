"""Databases of SQLite as they were at one moment, also while a daemon writes to them."""

import sqlite3
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from urllib.parse import quote

from inhand_runtime.errors import InhandError

PATIENCE_S = 30.0
"""Seconds for which it waits for a process that holds a database: one that makes its file anew."""
BESIDE = ("-wal", "-shm", "-journal")
"""Ends of the names of what SQLite has beside a database in use, or that of a killed process."""


@contextmanager
def copied_databases(databases: Iterable[Path], folder: Path) -> Iterator[dict[Path, Path]]:
    """Yield whole copies of the databases that there are, by these, until the end of the block.

    The copies are in a folder of their own within ``folder``, for their owner alone. Raises
    InhandError for one that cannot be read, or is damaged.
    """
    there = [path for path in sorted(databases) if path.is_file()]
    if not there:
        yield {}
        return
    try:
        copies = tempfile.TemporaryDirectory(prefix=".inhand-backup-", dir=folder)
    except OSError as error:
        raise InhandError(f"cannot write to {folder}: {error.strerror}") from None
    with copies as place:
        copied = {path: Path(place, str(number)) for number, path in enumerate(there)}
        for path, copy in copied.items():
            _copy(path, copy)
        yield copied


def _copy(path: Path, copy: Path) -> None:
    """Copy a database in one piece, by SQLite itself."""
    try:
        # An existing file alone, and written to by what SQLite itself does when it opens one.
        with (
            closing(
                sqlite3.connect(f"file:{quote(str(path))}?mode=rw", PATIENCE_S, uri=True)
            ) as source,
            closing(sqlite3.connect(copy)) as target,
        ):
            source.backup(target)
            target.execute("PRAGMA journal_mode = DELETE")
            (found,) = target.execute("PRAGMA quick_check(1)").fetchone()
    except sqlite3.Error as error:
        raise InhandError(f"the database {path} cannot be copied: {error}") from None
    if found != "ok":
        raise InhandError(f"the database {path} is damaged ({found}): move it away, or mend it")


def require_unused(path: Path) -> None:
    """Refuse a place of a database where SQLite would take what another one left for its own:
    raises InhandError."""
    for end in BESIDE:
        if (left := path.with_name(path.name + end)).exists():
            raise InhandError(
                f"{left} belongs to the database that is there: stop who uses it, and move both "
                "away; nothing was changed"
            )
