"""Events of a recorder, on ``event/{recorder}``: what it deletes, and when it stops."""

import logging
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from inhand_schemas.messages import Event

log = logging.getLogger(__name__)

RECORDING_DELETED = "recording_deleted"
RECORDING_STOPPED = "recording_stopped"
RECORDING_RESUMED = "recording_resumed"


class Announcer:
    """Publishes the events of one recorder, under its name."""

    def __init__(self, publish: Callable[[Event], None]) -> None:
        self._publish = publish
        self._next = 0

    def deleted(self, path: Path, size: int, why: str) -> None:
        """Announce that a recording was deleted."""
        log.warning("deleted %s: %s", path.name, why)
        self._announce(RECORDING_DELETED, f"{path.name}: {why}", {"bytes": size})

    def stopped(self, why: str, free_bytes: int) -> None:
        """Announce that nothing is written any more."""
        self._announce(RECORDING_STOPPED, why, {"free_bytes": free_bytes})

    def resumed(self, free_bytes: int) -> None:
        """Announce that recording goes on."""
        self._announce(RECORDING_RESUMED, "recording goes on", {"free_bytes": free_bytes})

    def _announce(self, kind: str, description: str, evidence: Mapping[str, float]) -> None:
        self._publish(
            Event(
                sequence=self._next,
                time_ns=time.time_ns(),
                kind=kind,
                description=description[:4096],
                evidence=dict(evidence),
            )
        )
        self._next += 1
