"""Whether somebody wants nothing to be measured now, over restarts too."""

import threading

from inhand_schemas.procedures import OutcomesReply, OutcomesRequest

from inhand_outcomes.store.database import Database
from inhand_outcomes.store.saving import STANDING, read_journal, write_journal

PAUSED = f"{STANDING}paused"
"""The journal's entry that is there while measuring is paused."""
PATIENCE_S = 1.5
"""Seconds that who asks waits until the database has it: the loop comes round four times a second,
and a database takes it in a tenth."""
NOT_KEPT = "the database takes nothing now: a restart may forget it"


class Pausing:
    """What is wanted, by any thread, and what the daemon's loop has made of it."""

    def __init__(self) -> None:
        self.paused = False
        self._changed = threading.Condition()
        self._wanted: bool | None = None
        self._kept: bool | None = None

    def want(self, *, paused: bool) -> None:
        """Ask the loop to pause, or to go on; from any thread."""
        with self._changed:
            self._wanted = paused

    def ask(self, instance: str, request: OutcomesRequest, *, paused: bool) -> OutcomesReply | None:
        """Ask so and wait until it is remembered; None where another instance is meant."""
        if request.outcomes not in (None, instance):
            return None
        self.want(paused=paused)
        with self._changed:
            done = self._changed.wait_for(lambda: self._is_kept(paused=paused), PATIENCE_S)
            problem = None if done else NOT_KEPT
            return OutcomesReply(outcomes=instance, paused=paused, problem=problem)

    # For the loop:

    def take_wanted(self) -> bool:
        """Take what somebody wants; whether it is another than before."""
        with self._changed:
            wanted, self._wanted = self._wanted, None
        if wanted is None or wanted == self.paused:
            return False
        self.paused = wanted
        return True

    def keep(self, database: Database) -> None:
        """Remember it, and at first what the last process of this database remembered; raises
        StoreError."""
        if self._kept is None:
            kept = PAUSED in read_journal(database)
            self.paused = self.paused or kept
        else:
            kept = self._kept
        if kept != self.paused:
            write_journal(database, {PAUSED: b"1" if self.paused else None})
        with self._changed:
            self._kept = self.paused
            self._changed.notify_all()

    def _is_kept(self, *, paused: bool) -> bool:
        return self._wanted is None and self._kept == paused
