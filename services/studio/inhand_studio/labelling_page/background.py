"""What takes long on a page runs in a thread of its own, one thing at a time, and can be ended."""

import threading
from collections.abc import Callable
from typing import Any, TypeVar

from inhand_lab.labelling.keyframes import LabellingError

from inhand_studio.visit import Visit

Result = TypeVar("Result")
Advance = Callable[[float], None]
"""It is called with the share, 0 to 1, that is done, and ends the work where that was asked for."""


class Ended(Exception):  # noqa: N818  # nothing went wrong
    """The work was asked to end."""


class Background:
    """The work of one page. ``doing`` says what runs, None where nothing does, and ``share`` how
    much of it is done."""

    def __init__(self, visit: Visit) -> None:
        self._visit = visit
        self._ending = threading.Event()
        self._closed = False
        self.doing: str | None = None
        self.share = 0.0

    def start(
        self, doing: str, work: Callable[[Advance], Result], done: Callable[[Result], None]
    ) -> None:
        """Do some work, then give its result to ``done`` with the visit's lock held.

        What it raises is shown in the tab. Raises LabellingError while something else runs.
        """
        if self.doing is not None:
            raise LabellingError(f"wait for what runs ({self.doing}), or cancel it first")
        self.doing, self.share = doing, 0.0
        self._ending = ending = threading.Event()

        def advance(share: float) -> None:
            if ending.is_set() or self._visit.closed:
                raise Ended
            self.share = share

        def run() -> None:
            result, error = _outcome(work, advance)
            self._visit.action(lambda _: self._finish(done, result, error))(None)

        threading.Thread(target=run, name=doing, daemon=True).start()

    def cancel(self) -> None:
        """Ask what runs to end."""
        self._ending.set()

    def close(self) -> None:
        """End what runs; nobody is told of it."""
        self._closed = True
        self._ending.set()

    def _finish(self, done: Callable[[Any], None], result: Any, error: Exception | None) -> None:
        self.doing = None
        if self._closed or isinstance(error, Ended):
            return
        if error is not None:
            raise error
        done(result)


def _outcome(work: Callable[[Advance], Any], advance: Advance) -> tuple[Any, Exception | None]:
    try:
        return work(advance), None
    except Exception as error:  # noqa: BLE001  # it is raised again in an action, which shows it
        return None, error
