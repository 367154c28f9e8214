"""Reports messages that never came, without flooding the log."""

from collections.abc import Callable

from inhand_runtime.wording import counted

from inhand_recorder.losses import LossCounter


class GapReporter:
    """Counts what is missing since the start, and reports a key each time its count doubled."""

    def __init__(self, report: Callable[[str], None]) -> None:
        self._report = report
        self._counter = LossCounter()
        self._reported: dict[str, int] = {}

    def count(self, key: str, sequence: int) -> None:
        """Take note of one message."""
        self._counter.count(key, sequence)

    def report(self) -> None:
        """Say what is missing now, where that is news."""
        for key, losses in self._counter.losses().items():
            if losses.lost >= max(1, 2 * self._reported.get(key, 0)):
                self._reported[key] = losses.lost
                self._report(
                    f"{counted(losses.lost, 'message')} of {key} missing so far: skipped by the "
                    "publisher, or lost on the way or in a full queue"
                )
