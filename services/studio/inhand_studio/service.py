"""The studio's daemon: serves the pages of a rig until it is stopped."""

import logging

import viser
from inhand_runtime.daemon import running_daemon
from inhand_runtime.settings import Settings

from inhand_studio.pages import PAGES
from inhand_studio.server import serving
from inhand_studio.settings import StudioSettings
from inhand_studio.studio import Studio
from inhand_studio.visit import Visit

log = logging.getLogger(__name__)

IDLE_S = 0.1
FOLDERS = {"dataset": "what the pages show and write (default: the setting)"}


def run(settings: Settings[StudioSettings]) -> None:
    """Serve until SIGTERM or SIGINT; raises InhandError where there is no session or no port."""
    chosen = settings.service
    with running_daemon("studio", settings) as daemon:
        studio = Studio(chosen.dataset, daemon)

        def visit_of(client: viser.ClientHandle) -> Visit:
            return Visit(client, studio, PAGES, "Live")

        with serving(chosen.host, chosen.port, visit_of) as port:
            log.info("the studio is at http://%s:%d", chosen.host, port)
            daemon.health.state = "running"
            while not daemon.stop.is_set():
                daemon.receive(IDLE_S)
