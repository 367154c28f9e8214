"""A camera whose pictures were drawn before it is opened: it costs as little as a real one.

Colour comes as JPEG, as from a camera that compresses it, and depth raw. Who is late gets the
newest picture, and what passed meanwhile is left out, as a driver does it.
"""

import itertools
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from inhand_lab.world.messages import camera_info
from inhand_lab.world.simulation import simulate
from inhand_runtime.pixels import encode_colour
from inhand_runtime.settings import Section
from inhand_runtime.source import Captured, Pixels
from inhand_schemas.messages import CameraInfo

RATE = 30.0


class DrawnOptions(Section):
    """What is drawn: somebody's performance, which is played forwards and back for ever."""

    interaction: str = "drinkFromMug"
    participant: int = 0
    frames: int = 120


class DrawnCamera:
    """See the module."""

    options_model = DrawnOptions

    def __init__(self, options: Mapping[str, Any]) -> None:
        chosen = DrawnOptions(**options)
        simulation = simulate(chosen.interaction, chosen.participant, 0, chosen.frames)
        self.info: CameraInfo = camera_info(simulation.intrinsics, RATE)
        seen = [simulation.render(frame) for frame in range(chosen.frames)]
        self._pictures = [Pixels(encode_colour(one.colour), one.depth) for one in seen]
        self._closed = threading.Event()

    def captures(self, _wanted: Callable[[], bool]) -> Iterator[Captured]:
        """Moments when they are due."""
        forwards = range(len(self._pictures))
        order = itertools.cycle((*forwards, *reversed(forwards)))
        due, due_ns = time.monotonic(), time.time_ns()
        while not self._closed.wait(max(0.0, due - time.monotonic())):
            pixels = self._pictures[next(order)]
            yield Captured(due_ns, 0, lambda pixels=pixels: pixels, None)
            passed = max(1, int((time.monotonic() - due) * RATE))
            due, due_ns = due + passed / RATE, due_ns + round(1e9 * passed / RATE)

    def close(self) -> None:
        """End ``captures``."""
        self._closed.set()
