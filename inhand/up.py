"""``inhand up``: run every process that the config names, supervised, until SIGTERM or Ctrl-C."""

import argparse
import sys
import threading
from pathlib import Path

from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE
from inhand_runtime.logs import configure_logs
from inhand_runtime.roll import Roll
from inhand_runtime.settings import RigFile, load_rig_file
from inhand_runtime.signals import set_on_signals
from inhand_schemas.messages import Health

from inhand.looking import open_look
from inhand.starts import require_startable
from inhand.supervisor import HANGS_AFTER_S, Child, Supervisor

STOP_ORDER = ("studio", "capture", "tracker", "recorder")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("--config", type=Path, metavar="FILE", help="the rig's settings (TOML)")
    parser.add_argument(
        "--check-config", action="store_true", help="check the settings of all, and start nothing"
    )


def run(arguments: argparse.Namespace) -> int:
    """Supervise until the end; raises SettingsError when there is nothing to run."""
    rig_file = load_rig_file(arguments.config)
    if rig_file.hub:
        raise SettingsError(
            f"{arguments.config} names a hub, which is run by itself: `inhand hub`, with "
            "settings of its own"
        )
    stages = [_children(rig_file, arguments.config, service) for service in STOP_ORDER]
    if not any(stages):
        raise SettingsError(
            f"{arguments.config or 'the settings'} names no process: add a table such as "
            "[capture.front], or give --config"
        )
    commands = {child.name: child.command for stage in stages for child in stage}
    stop = threading.Event()
    with set_on_signals(stop):
        require_startable(commands, stop)
    if arguments.check_config:
        print(f"{', '.join(commands)}: the settings are valid")
    if stop.is_set() or arguments.check_config:
        return DONE
    configure_logs(rig_file.log, "up")
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

    with open_look(arguments.config) as look:
        look.follow_tokens(roll.change)
        look.follow_health(hear)
        return Supervisor(stages, reports, look.can_hear).run()


def _children(rig_file: RigFile, config: Path | None, service: str) -> list[Child]:
    file = [] if config is None else ["--config", str(config)]
    return [
        Child(
            f"{service} {instance}",
            [sys.executable, "-m", "inhand", service, *file, "--name", instance],
        )
        for instance in getattr(rig_file, service)
    ]
