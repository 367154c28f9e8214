"""Hands what a recorder is asked to do from Zenoh's threads to the one that writes."""

import threading
from collections import OrderedDict, deque
from collections.abc import Callable
from concurrent.futures import Future
from functools import partial

from inhand_runtime.daemon import Daemon
from inhand_schemas.procedures import RECORDER_PROCEDURES, RecorderReply, RecorderRequest

PATIENCE_S = 1.5
"""Seconds that a request waits until it is done; who asks again has the reply to one that took
longer."""
MOST_REMEMBERED = 64
"""Number of requests whose replies are remembered, so that none is done twice."""

Command = tuple[str, str]
"""A verb, and the id of the request."""


class CommandDesk:
    """Takes requests from any thread, and has each done once, by the thread that serves."""

    def __init__(self, recorder: str) -> None:
        self._recorder = recorder
        self._lock = threading.Lock()
        self._replies: OrderedDict[Command, Future[RecorderReply]] = OrderedDict()
        self._waiting: deque[Command] = deque()

    def open(self, daemon: Daemon) -> None:
        """Let the daemon answer all procedures of a recorder from now on."""
        for procedure in RECORDER_PROCEDURES:
            daemon.answer(procedure, partial(self.ask, procedure.verb))

    def ask(self, verb: str, request: RecorderRequest) -> RecorderReply | None:
        """Wait until it is done; None where another recorder is asked, or it takes too long."""
        if request.recorder not in (None, self._recorder):
            return None
        try:
            return self._reply((verb, request.id)).result(PATIENCE_S)
        except TimeoutError:
            return None

    def serve(self, do: Callable[[str], RecorderReply]) -> None:
        """Have all that waits done: ``do`` takes a verb and returns the reply."""
        while self._waiting:
            command = self._waiting.popleft()
            with self._lock:
                reply = self._replies.get(command)
            if reply is not None:
                reply.set_result(do(command[0]))

    def _reply(self, command: Command) -> Future[RecorderReply]:
        with self._lock:
            if command not in self._replies:
                self._replies[command] = Future()
                self._waiting.append(command)
                while len(self._replies) > MOST_REMEMBERED:
                    self._replies.popitem(last=False)
            return self._replies[command]
