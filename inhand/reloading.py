"""Takes over settings that changed, while the processes run of which nothing changed."""

import hashlib
import logging
import os
import queue
import signal
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from pathlib import Path
from types import FrameType, TracebackType
from typing import Self

from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.logs import configure_logs
from inhand_runtime.settings import RigFile, load_rig_file

from inhand.rig_processes import RigProcess, rig_processes
from inhand.starts import StartError, require_startable
from inhand.up_socket import Answer, answering

log = logging.getLogger(__name__)

Stages = list[list[RigProcess]]

REFUSED = "nothing was changed: what runs goes on with its former settings"
FIXED = ("realm", "rig", "zenoh")
"""Settings that `inhand up` itself works with, and that it cannot take over."""


class Reloading:
    """From the beginning of its block on, SIGHUP and `inhand reload` are requests to reload.

    A thread checks what the file says by then; ``taken`` gives what is to run from now on. A file
    that is wrong in any way is refused as a whole. Where the terminal of this process is gone,
    SIGHUP is not a request but means, as ever, the end: ``on_hangup`` is called.
    """

    def __init__(
        self, config: Path | None, rig_file: RigFile, on_hangup: Callable[[], object]
    ) -> None:
        self.stages = rig_processes(rig_file, config)
        self._config = config
        self._rig_file = rig_file
        self._on_hangup = on_hangup
        self._digest = self._read_digest()
        self._requests: queue.SimpleQueue[Future[Answer] | None] = queue.SimpleQueue()
        self._ready: queue.SimpleQueue[Stages] = queue.SimpleQueue()
        self._ends = threading.Event()
        self._thread = threading.Thread(target=self._work, name="reload", daemon=True)
        self._previous = signal.getsignal(signal.SIGHUP)
        self._has_terminal = self._previous != signal.SIG_IGN and _terminal_is_there()
        self._socket = None if config is None else answering(config, self._ask)

    def __enter__(self) -> Self:
        signal.signal(signal.SIGHUP, self._note)
        self._thread.start()
        if self._socket is not None and not self._socket.__enter__():
            log.warning("`inhand reload` does not reach this process: another one has its place")
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._ends.set()
        self._requests.put(None)
        self._thread.join()
        if self._socket is not None:
            self._socket.__exit__(kind, error, traceback)
        signal.signal(signal.SIGHUP, self._previous)

    def taken(self) -> Stages | None:
        """Return what is to run, once, where settings were taken over since the last call."""
        try:
            return self._ready.get_nowait()
        except queue.Empty:
            return None

    def file_has_changed(self) -> bool:
        """Whether the file is another one than that whose settings are in use."""
        return self._read_digest() != self._digest

    def _note(self, _number: int, _frame: FrameType | None) -> None:
        if self._has_terminal and not _terminal_is_there():
            self._on_hangup()
        else:
            self._requests.put(Future())

    def _ask(self) -> Answer:
        request: Future[Answer] = Future()
        self._requests.put(request)
        return request.result()

    def _work(self) -> None:
        while (request := self._requests.get()) is not None:
            try:
                answer = Answer(True, tuple(self._reload()))
            except StartError as error:
                answer = Answer(False, (*error.lines, REFUSED))
            except InhandError as error:
                answer = Answer(False, (str(error), REFUSED))
            for line in answer.lines:
                log.log(logging.INFO if answer.taken else logging.ERROR, "reload: %s", line)
            request.set_result(answer)
        while not self._requests.empty():
            if (late := self._requests.get()) is not None:
                late.set_result(Answer(False, ("`inhand up` ends",)))

    def _reload(self) -> list[str]:
        """Check the file, hand over what is to run, and say what that changes; InhandError."""
        if self._config is None:
            raise SettingsError("there is no settings file: give --config to `inhand up`")
        digest = self._read_digest()
        rig_file = load_rig_file(self._config)
        for setting in FIXED:
            if getattr(rig_file, setting) != getattr(self._rig_file, setting):
                raise SettingsError(
                    f"{self._config}: {setting} cannot change while `inhand up` runs: start it "
                    "again; nothing was changed"
                )
        stages = rig_processes(rig_file, self._config)
        # All of them: one whose own table is as before may follow a camera that is gone.
        require_startable({one.name: one.command for one in _flat(stages)}, self._ends)
        if self._ends.is_set():
            raise InhandError("`inhand up` ends")
        lines = _differences(_flat(self.stages), _flat(stages))
        configure_logs(rig_file.log, "up")
        self._rig_file, self._digest, self.stages = rig_file, digest, stages
        self._ready.put(stages)
        return lines

    def _read_digest(self) -> str | None:
        """What tells the file's content from another; None where there is none to be read."""
        try:
            return None if self._config is None else _digest(self._config.read_bytes())
        except OSError:
            return None


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def _flat(stages: Stages) -> list[RigProcess]:
    return [one for stage in stages for one in stage]


def _differences(before: Sequence[RigProcess], after: Sequence[RigProcess]) -> list[str]:
    """Say what ends, starts anew, starts and goes on."""
    names, former = {one.name for one in after}, {one.name for one in before}
    groups = {
        "stops": [one.name for one in before if one.name not in names],
        "starts anew": [one.name for one in after if one.name in former and one not in before],
        "starts": [one.name for one in after if one.name not in former],
        "goes on": [one.name for one in after if one in before],
    }
    return [f"{what}: {', '.join(sorted(group))}" for what, group in groups.items() if group]


def _terminal_is_there() -> bool:
    """Whether this process has a terminal that can still be used."""
    try:
        os.close(os.open("/dev/tty", os.O_RDWR | os.O_NOCTTY))
    except OSError:
        return False
    return True
