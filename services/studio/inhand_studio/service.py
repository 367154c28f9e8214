"""The studio's daemon: serves the pages of a rig until it is stopped."""

import logging
import os
from pathlib import Path

import viser
from inhand_runtime.daemon import running_daemon
from inhand_runtime.errors import SettingsError
from inhand_runtime.settings import Settings, instance_settings, load_rig_file
from inhand_tracker.settings import TrackerSettings

from inhand_studio.access.gate import gate
from inhand_studio.access.listening import secluded_address
from inhand_studio.access.terms import terms_of
from inhand_studio.pages import PAGES
from inhand_studio.rig import Rig
from inhand_studio.server import serving
from inhand_studio.settings import StudioSettings
from inhand_studio.studio import Studio
from inhand_studio.visit import Visit

log = logging.getLogger(__name__)

IDLE_S = 0.1
NICENESS = 10
"""Where cores are few, capture and tracking go before those who watch them."""
FOLDERS = {"dataset": "what the pages show and write (default: the setting)"}


def check(settings: Settings[StudioSettings]) -> None:
    """Check all that can be known before a start; raises SettingsError."""
    terms_of(settings.service)


def run(settings: Settings[StudioSettings]) -> None:
    """Serve until SIGTERM or SIGINT.

    Raises SettingsError before anything starts, and InhandError where there is no session or port.
    """
    chosen = settings.service
    check(settings)
    os.setpriority(os.PRIO_PROCESS, 0, max(NICENESS, os.getpriority(os.PRIO_PROCESS, 0)))
    with running_daemon("studio", settings) as daemon:
        rig = Rig(daemon)
        config = settings.origin.path
        studio = Studio(chosen.dataset, daemon, rig=rig, models=models_of(config), config=config)

        def visit_of(client: viser.ClientHandle) -> Visit:
            return Visit(client, studio, PAGES, "Live")

        # The pages' own server asks nobody who he is: only the gate is told where it is.
        inside = secluded_address()
        with serving(inside, 0, visit_of) as port, gate(chosen, (inside, port)) as url:
            log.info("the studio is at %s", url)
            daemon.health.state = "running"
            while not daemon.stop.is_set():
                if (sample := daemon.receive(IDLE_S)) is not None:
                    rig.take(sample)


def models_of(path: Path | None) -> tuple[Path, ...]:
    """Return the files of the models that a rig's settings name for its trackers, on this machine.

    A tracker whose settings are wrong says so itself, and has none here. Raises SettingsError for a
    file that is no rig's.
    """
    rig_file = load_rig_file(path)
    models: list[Path] = []
    for name in rig_file.tracker:
        try:
            chosen = instance_settings(rig_file, path, "tracker", TrackerSettings, name).service
        except SettingsError as error:
            log.warning("its models are not known here: %s", error)
            continue
        models += chosen.model_files
    return tuple(dict.fromkeys(one for one in models if one.is_file()))
