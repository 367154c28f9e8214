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
STARTS_UP = """
import os, subprocess, sys
from inhand_runtime.supervisor_watch import supervised
command = [sys.executable, "-m", "inhand", "up", "--config", sys.argv[1]]
subprocess.run(command, env={**os.environ, **supervised()})
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


def test_a_rig_ends_with_the_program_that_started_it_for_itself(rig: RunningRig) -> None:
    rig.configure("[recorder.disk]\nfolder = 'kept'")
    program = rig.python("-c", STARTS_UP, rig.config)
    program.said("recorder disk is up")
    (up,) = psutil.Process(program.pid).children()
    (recorder,) = up.children()
    program.popen.kill()
    eventually("the end of the rig", lambda: not (_lives(up) or _lives(recorder)))


def _lives(process: psutil.Process) -> bool:
    return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
