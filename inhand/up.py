"""``inhand up``: run every process that the config names, supervised, until SIGTERM or Ctrl-C.

SIGHUP, as `inhand reload`, has it take over its settings file where that changed.
"""

import argparse
import threading
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path

from inhand_runtime.exit_codes import DONE
from inhand_runtime.logs import configure_logs
from inhand_runtime.session import open_session
from inhand_runtime.settings import RigFile, load_rig_file
from inhand_runtime.signals import set_on_signals
from inhand_runtime.supervisor_watch import end_with_supervisor

from inhand.reloading import Reloading, commands
from inhand.rig_processes import meets_without_hub, rig_processes
from inhand.starts import require_startable
from inhand.supervisor import Supervisor


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("--config", type=Path, metavar="FILE", help="the rig's settings (TOML)")
    parser.add_argument(
        "--check-config", action="store_true", help="check the settings of all, and start nothing"
    )


def run(arguments: argparse.Namespace) -> int:
    """Supervise until the end, which comes as well when a process that started this one as its
    supervisor is gone; raises SettingsError when there is nothing to run."""
    end_with_supervisor()
    stop = threading.Event()
    if arguments.check_config:
        stages = rig_processes(load_rig_file(arguments.config), arguments.config)
        with set_on_signals(stop):
            require_startable(commands(stages), {}, stop)
        if not stop.is_set():
            print(f"{', '.join(commands(stages))}: the settings are valid")
        return DONE
    with Reloading(arguments.config, stop.set) as reloading:
        with set_on_signals(stop):
            require_startable(commands(reloading.stages), reloading.environment(), stop)
        if stop.is_set():
            return DONE
        configure_logs(reloading.rig_file.log, "up")
        with _meeting(reloading.rig_file):
            return Supervisor(reloading, stop).run()


def _meeting(rig_file: RigFile) -> AbstractContextManager[object]:
    """Hold the address at which peers meet, so that the end of none of them takes it away; clients
    meet at a hub, which may come later than this process."""
    return open_session(rig_file.zenoh) if meets_without_hub(rig_file) else nullcontext()
