"""A source that is opened again when its device went away."""

import contextlib
import threading
import time
from collections.abc import Callable, Generator, Iterator

from inhand_runtime.source import QUIET_S, Captured, Source, SourceError, SourceLostError
from inhand_schemas.messages import CameraInfo

FIRST_PAUSE_S = 0.5
LONGEST_PAUSE_S = 10.0
STOP_POLL_S = 0.05


def growing_pauses() -> Iterator[float]:
    """Seconds to wait before each attempt to open a lost source again, doubling, for ever."""
    pause = FIRST_PAUSE_S
    while True:
        yield pause
        pause = min(2 * pause, LONGEST_PAUSE_S)


def captures(
    open_source: Callable[[], Source],
    wanted: Callable[[], bool],
    stop: threading.Event,
    *,
    opened: Callable[[CameraInfo], None],
    lost: Callable[[SourceError], None],
    pauses: Callable[[], Iterator[float]] = growing_pauses,
) -> Iterator[Captured | None]:
    """A source's moments until it ends or ``stop`` is set, across losses of its device.

    None comes while nothing happens, also while a lost source is waited for. ``opened`` is called
    each time before the first moment, ``lost`` at each loss and each attempt that failed. Raises
    SourceError when the source cannot be opened the first time, or cannot go on.
    """
    source: Source | None = open_source()
    remaining = pauses()
    while source is not None:
        try:
            with _closed_on(stop, source):
                opened(source.info)
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
    stop: threading.Event,
    pauses: Iterator[float],
    lost: Callable[[SourceError], None],
) -> Generator[None, None, Source | None]:
    for pause in pauses:
        end = time.monotonic() + pause
        while (rest := end - time.monotonic()) > 0.0:
            if stop.wait(min(rest, QUIET_S)):
                return None
            yield None
        try:
            return open_source()
        except SourceError as error:
            lost(error)
    return None


@contextlib.contextmanager
def _closed_on(stop: threading.Event, source: Source) -> Iterator[None]:
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
