"""``python -m inhand_studio.bound_verb PARENT SIGNAL VERB …``: a verb that ends with its parent.

It and its own processes get the signal when the process that started it has ended, however that
came; ``verb`` starts it, as the leader of a process group. The kernel's own such signal comes once
for each thread of the parent, and twice is too often for a verb that ends well at the first Ctrl-C
and at once at the second.
"""

import os
import runpy
import sys
import threading
import time

LOOK_EVERY_S = 0.2


def main() -> None:
    """Run the verb, and watch the parent beside it."""
    parent, number, *arguments = sys.argv[1:]
    watch = threading.Thread(target=end_with, args=(int(parent), int(number)), daemon=True)
    watch.start()
    sys.argv = ["inhand", *arguments]
    runpy.run_module("inhand", run_name="__main__", alter_sys=True)


def end_with(parent: int, number: int) -> None:
    """Send this process and those that it started a signal, once, when the parent is gone."""
    while os.getppid() == parent:
        time.sleep(LOOK_EVERY_S)
    os.killpg(os.getpgrp(), number)


if __name__ == "__main__":
    main()
