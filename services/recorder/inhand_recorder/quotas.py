"""How much a recorder keeps."""

from dataclasses import dataclass
from typing import Literal

FILES_WITHIN = 4
"""Number of files, at least, among which what a quota allows is divided: of one single file nothing
could be deleted while it grows."""
SMALLEST_FILE_BYTES = 1 << 20

WhenFull = Literal["stop", "delete-oldest"]


@dataclass(frozen=True)
class Quotas:
    """What is kept: ``keep_bytes`` of recordings, of the last ``keep_days``, and ``free_bytes`` of
    the disk stay free; 0 is no bound."""

    keep_bytes: int = 0
    keep_days: float = 0.0
    free_bytes: int = 0
    when_full: WhenFull = "stop"
