"""Keeps a process's memory out of core dumps."""

import ctypes
import os
import resource
import sys

from inhand_runtime.errors import InhandError

_PR_SET_DUMPABLE = 4


def forbid_core_dumps() -> None:
    """Let the system write no image of this process's memory when it crashes, nor another read it.

    Raises InhandError when the system refuses.
    """
    _, hard = resource.getrlimit(resource.RLIMIT_CORE)
    resource.setrlimit(resource.RLIMIT_CORE, (0, hard))
    if sys.platform == "linux":  # where dumps go to a program, no limit holds
        if ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_DUMPABLE, 0, 0, 0, 0) != 0:
            raise InhandError(
                "core dumps, which would hold what masks cover, cannot be switched off "
                f"({os.strerror(ctypes.get_errno())}): run it where prctl is allowed"
            )
