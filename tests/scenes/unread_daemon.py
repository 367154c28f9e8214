"""A daemon without a session, whose inbox a test fills."""

import threading
from dataclasses import dataclass, field

from inhand_runtime.health import HealthBoard
from inhand_runtime.inbox import Inbox, Received


@dataclass
class UnreadDaemon:
    """What a recorder needs of its daemon."""

    instance: str = "disk"
    health: HealthBoard = field(default_factory=lambda: HealthBoard("recorder", "disk"))
    inbox: Inbox = field(default_factory=Inbox)
    stop: threading.Event = field(default_factory=threading.Event)

    def receive(self, timeout_s: float) -> Received | None:
        """The next sample, or None."""
        return self.inbox.get(timeout_s)


class EndingDaemon(UnreadDaemon):
    """One that stops when all was read."""

    def receive(self, _timeout_s: float) -> Received | None:
        """The next sample; None when all was read."""
        sample = self.inbox.get(0)
        if sample is None:
            self.stop.set()
        return sample
