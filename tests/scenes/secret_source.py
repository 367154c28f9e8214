"""A source that shows a secret in the left half of its pictures, and then crashes as told.

``end`` is "exception" (a fault of the program), "lost" (a device that goes away), or "abort" (the
process dies at once, as a fault in C makes it).
"""

import os
import threading
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
from inhand_runtime.settings import Section
from inhand_runtime.source import Captured, Pixels, SourceLostError
from inhand_schemas.messages import CameraInfo

WIDTH, HEIGHT = 128, 96
COLOUR, DEPTH = (201, 17, 93), 54_321
MOMENTS = 30


class SecretOptions(Section):
    """How it ends."""

    end: str


class SecretSource:
    """See the module."""

    options_model = SecretOptions
    info = CameraInfo(sequence=0, time_ns=0, width=WIDTH, height=HEIGHT, fx=90, fy=90, cx=64, cy=48)

    def __init__(self, options: Mapping[str, Any]) -> None:
        self._end = options["end"]
        self._closed = threading.Event()

    def captures(self, _wanted: Callable[[], bool]) -> Iterator[Captured]:
        """Moments, and the crash."""
        for number in range(MOMENTS):
            if self._closed.wait(0.02):
                return
            yield Captured(1_700_000_000_000_000_000 + number, 0, _pixels, None)
        match self._end:
            case "exception":
                raise ValueError("the program is wrong")
            case "lost":
                raise SourceLostError("the camera went away")
            case "abort":
                os.abort()

    def close(self) -> None:
        """End ``captures``."""
        self._closed.set()


def _pixels() -> Pixels:
    colour = np.full((HEIGHT, WIDTH, 3), 40, np.uint8)
    depth = np.full((HEIGHT, WIDTH), 1_000, np.uint16)
    colour[:, : WIDTH // 2], depth[:, : WIDTH // 2] = COLOUR, DEPTH
    return Pixels(colour, depth)
