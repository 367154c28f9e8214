"""A source that does what its options say: moments, losses and faults, one after the other.

``script`` is a list: a number publishes so many moments, "lost" is a device that goes away,
"broken" a fault for good, "hang" waits until closed. Each time the source is opened it goes on
where it stopped; "closed" and "absent" in the script make that opening fail.
"""

import threading
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
from inhand_runtime.source import Captured, Pixels, SourceAbsentError, SourceError, SourceLostError
from inhand_schemas.messages import CameraInfo, ObjectPose, Person

WIDTH, HEIGHT = 64, 48
FIRST_NS = 1_700_000_000_000_000_000
FRAME_NS = 10_000_000

PERSON = Person(
    id=1, joints=((0.1, 0.2, 2.0),) * 20, states=("tracked",) * 20, confidences=(0.5,) * 20
)

Step = int | str


class ScriptedSource:
    """See the module."""

    steps: list[Step] = []
    published = 0

    def __init__(self, options: Mapping[str, Any]) -> None:
        if not self.steps:
            ScriptedSource.steps = list(options["script"])
        self._closed = threading.Event()
        if self.steps[0] == "absent":
            self.steps.pop(0)
            raise SourceAbsentError("the scripted camera is not plugged in")
        if self.steps[0] == "closed":
            self.steps.pop(0)
            raise SourceError("no scripted camera is connected")

    @property
    def info(self) -> CameraInfo:
        """Of a small camera."""
        return CameraInfo(
            sequence=0, time_ns=0, width=WIDTH, height=HEIGHT, fx=50, fy=50, cx=32, cy=24
        )

    def captures(self, wanted: Callable[[], bool]) -> Iterator[Captured]:
        """What the script says, 100 times a second."""
        while self.steps:
            match self.steps.pop(0):
                case int(count):
                    for _ in range(count):
                        if self._closed.wait(FRAME_NS / 1e9):
                            return
                        yield moment(ScriptedSource.published)
                        ScriptedSource.published += 1
                case "lost":
                    raise SourceLostError("the scripted camera went away: plug it in again")
                case "broken":
                    raise SourceError("the scripted camera is broken: buy another")
                case "hang":
                    self._closed.wait()
                    return

    def close(self) -> None:
        """End ``captures``."""
        self._closed.set()


def moment(number: int) -> Captured:
    """One moment with a person, two pictures and a mug's label."""
    time_ns = FIRST_NS + number * FRAME_NS
    return Captured(
        time_ns=time_ns,
        time_uncertainty_ns=1000,
        pixels=lambda: Pixels(
            np.zeros((HEIGHT, WIDTH, 3), np.uint8), np.full((HEIGHT, WIDTH), number, np.uint16)
        ),
        people=(PERSON,),
        labels=(
            ObjectPose(sequence=0, time_ns=0, object="mug", camera="x", state="lost", confidence=1),
        ),
        convention="kinect_v2",
    )
