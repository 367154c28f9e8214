"""A source that is opened again when its device went away."""

import contextlib
import threading
import time
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import Future, wait
from typing import Protocol

from inhand_runtime.source import (
    QUIET_S,
    Captured,
    Source,
    SourceAbsentError,
    SourceError,
    SourceLostError,
)

FIRST_PAUSE_S = 0.5
LONGEST_PAUSE_S = 2.0
"""Seconds between two attempts, at the most: who plugs a camera in waits no longer."""
STOP_POLL_S = 0.05
ENDS_OPENING_S = 1.5
"""Seconds in which an opening that is under way at a stop may end, to be closed in order."""
RESTARTS_WITHIN_S = 15.0
"""Seconds after a loss in which a device that is absent is only restarting: no new error."""


class Ending(Protocol):
    """Tells when capturing has to end, as a threading.Event does."""

    def is_set(self) -> bool:
        """Whether it has to end."""

    def wait(self, timeout: float) -> bool:
        """Wait for the end, or for seconds; returns whether it has come."""


def growing_pauses() -> Iterator[float]:
    """Seconds to wait before each attempt to open a lost source again, growing, for ever."""
    pause = FIRST_PAUSE_S
    while True:
        yield pause
        pause = min(2 * pause, LONGEST_PAUSE_S)


def captures(
    open_source: Callable[[], Source],
    wanted: Callable[[], bool],
    stop: Ending,
    *,
    opened: Callable[[Source], None],
    lost: Callable[[SourceError], None],
    pauses: Callable[[], Iterator[float]] = growing_pauses,
) -> Iterator[Captured | None]:
    """A source's moments until it ends or ``stop`` is set, across losses of its device.

    None comes while nothing happens, also while a source is opened or waited for. ``opened`` is
    called each time before the first moment, ``lost`` at each loss and each attempt that failed.
    Raises SourceError when the source cannot go on, or can never be opened; a device that is only
    absent is waited for from the start.
    """
    remaining = pauses()
    try:
        source = yield from _opened(open_source, stop)
    except SourceLostError as error:
        lost(error)
        source = yield from _open_again(open_source, stop, remaining, lost)
    while source is not None:
        try:
            with _closed_on(stop, source):
                opened(source)
                for captured in source.captures(wanted):
                    if stop.is_set():
                        return
                    if captured is not None:
                        remaining = pauses()
                    yield captured
            return
        except SourceLostError as error:
            if stop.is_set():
                return
            lost(error)
        source = yield from _open_again(open_source, stop, remaining, lost)


def _open_again(
    open_source: Callable[[], Source],
    stop: Ending,
    pauses: Iterator[float],
    lost: Callable[[SourceError], None],
) -> Generator[None, None, Source | None]:
    restarts_until = time.monotonic() + RESTARTS_WITHIN_S
    for pause in pauses:
        end = time.monotonic() + pause
        while (rest := end - time.monotonic()) > 0.0:
            if stop.wait(min(rest, QUIET_S)):
                return None
            yield None
        try:
            return (yield from _opened(open_source, stop))
        except SourceAbsentError as error:
            if time.monotonic() > restarts_until:
                lost(error)
        except SourceError as error:
            lost(error)
    return None


def _opened(
    open_source: Callable[[], Source], stop: Ending
) -> Generator[None, None, Source | None]:
    """Open a source in a thread of its own, since a camera takes seconds; None when stopped.

    What is opened after the stop is closed at once, if the process lives as long.
    """
    opening: Future[Source] = Future()

    def run() -> None:
        try:
            opening.set_result(open_source())
        except BaseException as error:  # noqa: BLE001 - it is raised again where it is waited for
            opening.set_exception(error)

    threading.Thread(target=run, name="open-source", daemon=True).start()
    quiet_since = time.monotonic()
    while not wait([opening], STOP_POLL_S).done:
        if stop.is_set():
            wait([opening], ENDS_OPENING_S)
            opening.add_done_callback(_close)
            return None
        if time.monotonic() - quiet_since > QUIET_S:
            yield None
            quiet_since = time.monotonic()
    return opening.result()


def _close(opening: Future[Source]) -> None:
    if opening.exception() is None:
        opening.result().close()


@contextlib.contextmanager
def _closed_on(stop: Ending, source: Source) -> Iterator[None]:
    """Close the source at the end of the block, and at once when ``stop`` is set."""
    ended = threading.Event()

    def watch() -> None:
        while not ended.is_set():
            if stop.wait(STOP_POLL_S):
                source.close()
                return

    watcher = threading.Thread(target=watch, name="stop-source")
    watcher.start()
    try:
        yield
    finally:
        ended.set()
        watcher.join()
        source.close()
