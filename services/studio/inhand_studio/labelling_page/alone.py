"""The labelling page alone, for one recording, without a rig."""

import threading
from contextlib import ExitStack
from importlib import import_module
from pathlib import Path

import viser
from inhand_runtime.errors import InhandError
from inhand_runtime.signals import set_on_signals

from inhand_studio.access.gate import gate
from inhand_studio.access.listening import secluded_address
from inhand_studio.pages import PAGES
from inhand_studio.server import serving
from inhand_studio.settings import StudioSettings
from inhand_studio.studio import Studio
from inhand_studio.visit import Visit


def serve_alone(dataset: Path, recording: Path, object_name: str | None) -> None:
    """Serve the page to browsers of this machine, and print its address, until SIGTERM or Ctrl-C.

    It is on a studio's usual port, or a free one where that is taken.
    """
    import_module(PAGES["Label"])  # seconds, which the first tab would wait for
    studio = Studio(dataset, None, recording, object_name)

    def visit_of(client: viser.ClientHandle) -> Visit:
        return Visit(client, studio, PAGES, "Label")

    stop = threading.Event()
    with set_on_signals(stop), ExitStack() as served:
        inside = secluded_address()
        inner = inside, served.enter_context(serving(inside, 0, visit_of))
        try:
            url = served.enter_context(gate(StudioSettings(), inner))
        except InhandError:
            url = served.enter_context(gate(StudioSettings(port=0), inner))
        print(
            f"label {recording.name} at {url} (Ctrl-C ends it; every change is saved)", flush=True
        )
        stop.wait()
