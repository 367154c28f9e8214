"""Whether the processes of a rig can start: each checks its settings itself, all at once."""

import os
import signal
import subprocess
import threading
from collections.abc import Mapping, Sequence

from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE

from inhand.last_words import Told

POLL_S = 0.05


class StartError(SettingsError):
    """Some processes cannot start; ``lines`` say why."""

    def __init__(self, message: str, lines: tuple[str, ...]) -> None:
        super().__init__(message)
        self.lines = lines


def require_startable(
    commands: Mapping[str, Sequence[str]], environment: Mapping[str, str], stop: threading.Event
) -> None:
    """Raise StartError, which says why, when any cannot start; each prints its line as well.

    ``commands`` start each process by its name; ``--check-config`` is added to them, and
    ``environment`` to this process's own. Ends early when ``stop`` is set.
    """
    checks = {
        name: subprocess.Popen(
            [*command, "--check-config"],
            env={**os.environ, **environment},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            process_group=0,
        )
        for name, command in commands.items()
    }
    told = {name: Told(check.stderr) for name, check in checks.items() if check.stderr is not None}
    try:
        while any(check.poll() is None for check in checks.values()):
            if stop.wait(POLL_S):
                return
    finally:
        for check in checks.values():
            check.send_signal(signal.SIGKILL)
            check.wait()
    if wrong := [name for name, check in checks.items() if check.returncode != DONE]:
        has = "has" if len(wrong) == 1 else "have"
        whys = dict.fromkeys(told[name].last_line() for name in wrong)
        raise StartError(
            f"{' and '.join(wrong)} {has} wrong settings (see above): nothing was started",
            tuple(whys),
        )
