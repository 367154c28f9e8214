"""Whether the processes of a rig can start: each checks its settings itself, all at once."""

import signal
import subprocess
import threading
from collections.abc import Mapping, Sequence

from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE

POLL_S = 0.05


def require_startable(commands: Mapping[str, Sequence[str]], stop: threading.Event) -> None:
    """Raise SettingsError, after the lines of those that cannot start, when any cannot.

    ``commands`` start each process by its name; ``--check-config`` is added to them. Ends early
    when ``stop`` is set.
    """
    checks = {
        name: subprocess.Popen(
            [*command, "--check-config"],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            process_group=0,
        )
        for name, command in commands.items()
    }
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
        raise SettingsError(
            f"{' and '.join(wrong)} {has} wrong settings (see above): nothing was started"
        )
