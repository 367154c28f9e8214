"""Takes over settings that changed, while the processes run of which nothing changed."""

import contextlib
import logging
import os
import queue
import signal
import threading
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from pathlib import Path
from types import FrameType, TracebackType
from typing import Self

from inhand_runtime.accepted_settings import AcceptedSettings
from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.logs import configure_logs
from inhand_runtime.settings import RigFile, load_rig_file, rig_file_of
from inhand_runtime.settings_file import settings_data, values_in

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

    def __init__(self, config: Path | None, on_hangup: Callable[[], object]) -> None:
        """Raises SettingsError for a file that is wrong, or names nothing to run."""
        data = b"" if config is None else settings_data(config)
        rig_file = load_rig_file(None) if config is None else _rig_file(data, config)
        self.stages = rig_processes(rig_file, config)
        self._config = config
        self._rig_file = rig_file
        self._on_hangup = on_hangup
        self._accepted = _accepted(config, data)
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

    @property
    def rig_file(self) -> RigFile:
        """The settings in use."""
        return self._rig_file

    def environment(self) -> Mapping[str, str]:
        """Return the variables by which a child reads what was accepted, whatever the file says."""
        accepted = self._accepted
        return {} if accepted is None else accepted.environment()

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
        data = settings_data(self._config)
        rig_file = _rig_file(data, self._config)
        for setting in FIXED:
            if getattr(rig_file, setting) != getattr(self._rig_file, setting):
                raise SettingsError(
                    f"{self._config}: {setting} cannot change while `inhand up` runs: start it "
                    "again"
                )
        stages = rig_processes(rig_file, self._config)
        new = _accepted(self._config, data)
        try:
            # All of them: one whose own table is as before may follow a camera that is gone.
            environment = {} if new is None else new.environment()
            require_startable(commands(stages), environment, self._ends)
            if self._ends.is_set():
                raise InhandError("`inhand up` ends")
        except InhandError:
            if new is not None:
                new.close()
            raise
        # The former one stays: a process that goes on may read its settings again.
        lines = _differences(_flat(self.stages), _flat(stages))
        configure_logs(rig_file.log, "up")
        self._rig_file, self._accepted, self.stages = rig_file, new, stages
        self._ready.put(stages)
        return lines


def commands(stages: Stages) -> dict[str, tuple[str, ...]]:
    """Return the command that starts each process, by its name."""
    return {one.name: one.command for one in _flat(stages)}


def _rig_file(data: bytes, config: Path) -> RigFile:
    return rig_file_of(values_in(data, config), config)


def _accepted(config: Path | None, data: bytes) -> AcceptedSettings | None:
    """Keep what was accepted; where that cannot be, processes read the file."""
    with contextlib.suppress(OSError, AttributeError):
        return None if config is None else AcceptedSettings(config, data)
    return None


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
