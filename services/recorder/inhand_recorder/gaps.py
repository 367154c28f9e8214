"""Tells of messages that never came, without flooding the log."""

from collections.abc import Callable

from inhand_recorder.losses import LossCounter


class GapTeller:
    """Counts what is missing since the start, and tells of a key each time its count doubled."""

    def __init__(self, tell: Callable[[str], None]) -> None:
        self._tell = tell
        self._counter = LossCounter()
        self._told: dict[str, int] = {}

    def count(self, key: str, sequence: int) -> None:
        """Take note of one message."""
        self._counter.count(key, sequence)

    def tell(self) -> None:
        """Say what is missing now, where that is news."""
        for key, losses in self._counter.losses().items():
            if losses.lost >= max(1, 2 * self._told.get(key, 0)):
                self._told[key] = losses.lost
                self._tell(
                    f"{losses.lost} messages of {key} are missing so far: their publisher skipped "
                    "them, or they were lost on the way or in a full queue"
                )
