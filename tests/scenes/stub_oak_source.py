"""The OAK driver with stubbed sensors as a plugin: it plays a recording, and is lost as told.

``script`` has one word for each opening: "break", "crash" and "silence" happen after ten moments,
"absent" is a camera that is not there, "play" goes on for ever.
"""

import logging
import threading
from collections.abc import Mapping
from typing import Any

from inhand_capture.sources.oak.controls import CONTROLS
from inhand_capture.sources.oak.source import OakSource
from inhand_runtime.settings import FilePath, Section
from inhand_runtime.source import SourceAbsentError
from stub_oak import StubCamera, recorded_shots

log = logging.getLogger(__name__)

MOMENTS = 10
PERIOD_S = 0.02


class StubOptions(Section):
    """What is played, and when it is lost."""

    recording: FilePath
    script: list[str]


class StubOakSource(OakSource):
    """See the module."""

    options_model = StubOptions
    script: list[str] = []
    exposed = 0

    def __init__(self, options: Mapping[str, Any]) -> None:
        if not self.script:
            StubOakSource.script = list(options["script"])
        word = self.script.pop(0)
        if word == "absent":
            raise SourceAbsentError("no OAK camera is attached: plug it in")
        camera = StubCamera(shots=recorded_shots(options["recording"]), first=())
        camera.on_connect = lambda camera: threading.Thread(
            target=_expose, args=(camera, word), daemon=True
        ).start()
        own = {name: value for name, value in options.items() if name in CONTROLS}
        log.info("opened with exposure %s", own.get("exposure_us"))
        super().__init__({"mjpeg": False, **own}, camera.connect)


def _expose(camera: StubCamera, word: str) -> None:
    moments = 0
    while not camera.ended.wait(PERIOD_S):
        if word == "play" or moments < MOMENTS:
            camera.send(StubOakSource.exposed)
            StubOakSource.exposed += 1
            moments += 1
        elif word != "silence":
            camera.died = "the camera's firmware crashed" if word == "crash" else None
            camera.break_link()
            return
