"""Stopping on SIGTERM and Ctrl-C, whatever the main thread is doing."""

import contextlib
import os
import signal
import socket
import threading
from collections.abc import Iterator

STOP_SIGNALS = (signal.SIGTERM, signal.SIGINT)


@contextlib.contextmanager
def set_on_signals(stop: threading.Event) -> Iterator[None]:
    """Set ``stop`` at the first SIGTERM or SIGINT; a second one ends the process at once.

    Outside the main thread signals are left alone.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    # A thread of its own sets the event: a handler in the main thread would wait for that
    # thread's long C calls, and deadlock where the signal comes amid ``stop.wait()``.
    reading, writing = socket.socketpair()
    writing.setblocking(False)
    watcher = threading.Thread(target=_watch, args=(reading, stop), name="signals")
    previous = {number: signal.signal(number, lambda *_: None) for number in STOP_SIGNALS}
    previous_descriptor = signal.set_wakeup_fd(writing.fileno(), warn_on_full_buffer=False)
    watcher.start()
    try:
        yield
    finally:
        signal.set_wakeup_fd(previous_descriptor)
        for number, handler in previous.items():
            signal.signal(number, handler)
        writing.close()
        watcher.join()
        reading.close()


def _watch(signals: socket.socket, stop: threading.Event) -> None:
    while number := signals.recv(1):
        if number[0] in STOP_SIGNALS:
            if stop.is_set():
                os._exit(128 + number[0])
            stop.set()
