"""``python -m inhand_studio.bound_verb PARENT SIGNAL VERB …``: a verb that ends with its parent.

It gets the signal when the thread that started it ends, however that comes; ``verb`` starts it.
"""

import ctypes
import os
import runpy
import signal
import sys

_PR_SET_PDEATHSIG = 1


def main() -> None:
    """Bind this process to its parent, and run the verb."""
    parent, number, *arguments = sys.argv[1:]
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(number))
    if os.getppid() != int(parent):  # it ended before
        os.kill(os.getpid(), signal.SIGKILL)
    sys.argv = ["inhand", *arguments]
    runpy.run_module("inhand", run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    main()
