"""What becomes of children whose supervisor was killed."""

import sys
from pathlib import Path

import psutil
from running_rig import RunningRig, eventually

DAEMON = Path(__file__).with_name("small_daemon.py")
SUPERVISES = """
import sys, time
from inhand.child import Child
child = Child("tracker small", sys.argv[1:])
while True:
    child.tend()
    time.sleep(0.02)
"""
SOON = f"""
import runpy, sys
from inhand_runtime import supervisor_watch
supervisor_watch.ENDS_WITHIN_S = 0.5
runpy.run_path({str(DAEMON)!r}, run_name="__main__")
"""


def test_not_even_a_child_that_hangs_outlives_a_killed_supervisor(rig: RunningRig) -> None:
    command = (sys.executable, "-c", SOON, "--config", rig.config)
    up = rig.python("-c", SUPERVISES, *command, INHAND_TRACKER__SMALL__STUCK="true")
    up.said("tracker small is up")
    (child,) = psutil.Process(up.pid).children()
    up.popen.kill()
    eventually("the end of the child", lambda: not _lives(child))
    # Its name is free.
    again = rig.python(DAEMON, "--config", rig.config, "--name", "small")
    again.said("tracker small is up")


def _lives(process: psutil.Process) -> bool:
    return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
