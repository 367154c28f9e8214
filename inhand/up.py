"""``inhand up``: run every process that the config names, supervised, until SIGTERM or Ctrl-C.

SIGHUP, as `inhand reload`, has it take over its settings file where that changed.
"""

import argparse
import threading
from pathlib import Path

from inhand_runtime.exit_codes import DONE
from inhand_runtime.logs import configure_logs
from inhand_runtime.roll import Roll
from inhand_runtime.settings import load_rig_file
from inhand_runtime.signals import set_on_signals
from inhand_schemas.messages import Health

from inhand.child import HANGS_AFTER_S
from inhand.looking import open_look
from inhand.reloading import Reloading, commands
from inhand.rig_processes import rig_processes
from inhand.starts import require_startable
from inhand.supervisor import Supervisor


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("--config", type=Path, metavar="FILE", help="the rig's settings (TOML)")
    parser.add_argument(
        "--check-config", action="store_true", help="check the settings of all, and start nothing"
    )


def run(arguments: argparse.Namespace) -> int:
    """Supervise until the end; raises SettingsError when there is nothing to run."""
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
        configure_logs(reloading.log_settings, "up")
        return _supervise(arguments.config, reloading, stop)


def _supervise(config: Path | None, reloading: Reloading, stop: threading.Event) -> int:
    roll = Roll()

    def reports(name: str) -> int | None:
        living = roll.living()
        instance = tuple(name.split(" "))
        if instance not in living:
            return None
        heard = living[instance]
        return 0 if heard is None else heard.reports

    def hear(health: Health) -> None:
        if health.loop_age_s < HANGS_AFTER_S:
            roll.hear(health)

    with open_look(config) as look:
        look.follow_tokens(roll.change)
        look.follow_health(hear)
        return Supervisor(reloading, reports, look.can_hear, stop).run()
