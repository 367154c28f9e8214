"""Tells when too much of what comes goes short: poses without pictures, skeletons skipped."""

from collections import deque

from inhand_runtime.health import HealthBoard

JUDGED = 90
"""Number of the last ones that are judged: three seconds at 30 Hz."""
MOST_SHORT = 0.2
"""Share of them that may go short."""
JUDGED_EVERY = 30
"""Number from one judgement to the next: what changes with each would be logged with each."""
LASTS_S = 5.0
"""Seconds for which the trouble lasts when no more come."""


class Shortfall:
    """A trouble called ``name`` while too many go short; ``text`` says of what, and why."""

    def __init__(self, health: HealthBoard, name: str, text: str) -> None:
        self._health = health
        self._name = name
        self._text = text
        self._short: deque[bool] = deque(maxlen=JUDGED)
        self._ever_whole = False
        self._noted = 0

    def note(self, short: bool) -> None:
        """Take note of one; where none was ever whole it is not expected, and no trouble."""
        self._ever_whole |= not short
        self._short.append(short)
        self._noted += 1
        if self._noted % JUDGED_EVERY:
            return
        count = self._short.count(True)
        if self._ever_whole and len(self._short) == JUDGED and count > MOST_SHORT * JUDGED:
            text = f"{count} of {JUDGED} {self._text}"
            self._health.trouble(self._name, text, lasts_s=LASTS_S)
        else:
            self._health.well(self._name)
