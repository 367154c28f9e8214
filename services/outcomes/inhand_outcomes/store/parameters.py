"""The numbers by which a store works."""

from dataclasses import dataclass


@dataclass(frozen=True)
class StoreParameters:
    """How long a store waits, and how much it takes of memory and disk beside its tables."""

    patience_s: float = 5.0
    """Seconds for which it waits for another process that holds the database: longer than a
    year's removal of details takes."""
    log_bytes: int = 4 << 20
    """Size to which SQLite's write-ahead log is cut again after a large change."""
    cache_kib: int = 2048
    """Pages of a file of SQLite that are held in memory, in KiB: SQLite's own default."""


DEFAULT_STORE = StoreParameters()


@dataclass(frozen=True)
class WaitingParameters:
    """What waits while a database cannot be written."""

    most: int = 20_000
    """Number of outcomes that wait: of a month and more in a busy home, in about 40 MB."""
    first_wait_s: float = 1.0
    """Seconds after a failure until the next try; they double with each."""
    longest_wait_s: float = 60.0
    """Seconds at most between two tries."""


DEFAULT_WAITING = WaitingParameters()
