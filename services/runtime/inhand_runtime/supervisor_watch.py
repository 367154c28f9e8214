"""Ends this process when the supervisor that started it is gone, however that one ended.

A process that was killed ends nobody, and daemons that it leaves behind keep their names from those
that come after. So each looks itself whether its supervisor still lives, which works on every
system and leaves the start of a child as plain as it can be.
"""

import os
import signal
import threading
import time

from inhand_runtime.exit_codes import FAILED

_VARIABLE = "INHAND_SUPERVISOR"
POLL_S = 0.5
ENDS_WITHIN_S = 10.0
"""Seconds that this process has to end as on SIGTERM, after which it ends where it stands."""


def supervised() -> dict[str, str]:
    """Return what the environment of a child is to have so that it ends with this process."""
    return {_VARIABLE: str(os.getpid())}


def end_with_supervisor() -> None:
    """Watch the supervisor that the environment names from now on; without one nothing is done."""
    named = os.environ.pop(_VARIABLE, "")
    if named:
        threading.Thread(target=_watch, args=(int(named),), name="supervisor", daemon=True).start()


def _watch(supervisor: int) -> None:
    while os.getppid() == supervisor:
        time.sleep(POLL_S)
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(ENDS_WITHIN_S)
    os._exit(FAILED)
