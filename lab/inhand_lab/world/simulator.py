"""The source ``simulator``: somebody who uses an object before a camera, for ever if need be."""

import itertools
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from typing import Annotated, Any, Literal

from inhand_runtime.settings import Section
from inhand_runtime.settings_errors import explain, suggestion
from inhand_runtime.source import Captured, Pixels, SourceError
from inhand_schemas.conventions import SIMULATED
from inhand_schemas.messages import CameraInfo
from pydantic import AfterValidator, Field, ValidationError

from inhand_lab.sensing.cameras import CAMERAS
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.messages import camera_info, label_message, person_message
from inhand_lab.world.simulation import SensedFrame, Simulation, simulate

UNNAMED_CAMERA = "simulator"
"""Name of the camera in labels, until capture puts its own in its place."""

LONGEST_DELAY = 0.25
"""Delay, in periods, beyond which the world stands still instead of hurrying after its time: on a
busy machine the simulator draws fewer frames, and none whose time is long past."""

PREPARED_AHEAD_S = 4.0
"""Time before its first frame at which the next performance is prepared, seconds: memory holds two
from then on."""


def _known(interaction: str) -> str:
    if interaction not in INTERACTIONS:
        raise ValueError(f"nobody knows {interaction!r}" + suggestion(interaction, INTERACTIONS))
    return interaction


class SimulatorOptions(Section):
    """``[capture.NAME.options]`` of a simulator.

    ``frames`` make one performance; with ``loop`` the next follows it, each a fresh one.
    """

    interaction: Annotated[str, AfterValidator(_known)] = "drinkFromMug"
    camera: Literal["kinect", "oak_d"] = "kinect"
    participant: Annotated[int, Field(ge=0)] = 0
    seed: Annotated[int, Field(ge=0)] = 0
    frames: Annotated[int, Field(ge=1)] = 360
    frame_rate: Annotated[float, Field(gt=0, le=240)] = 30.0
    loop: bool = True


class SimulatorSource:
    """A simulated participant before a simulated camera, in real time, with the truth."""

    options_model = SimulatorOptions

    def __init__(self, options: Mapping[str, Any]) -> None:
        try:
            self._options = SimulatorOptions(**options)
        except ValidationError as error:
            raise SourceError(explain(error, None, ("options",), SimulatorOptions)) from None
        self._closed = threading.Event()
        self._first: Simulation | None = self._perform(0)

    @property
    def info(self) -> CameraInfo:
        """How the simulated camera sees."""
        camera = CAMERAS[self._options.camera]
        return camera_info(camera.intrinsics, self._options.frame_rate)

    def captures(self, wanted: Callable[[], bool]) -> Iterator[Captured]:
        """Frames when they are due, rendered before that if pixels are wanted."""
        period = 1.0 / self._options.frame_rate
        due = time.monotonic()
        due_ns = _on_the_wall(due)
        for simulation, frame in self._frames():
            ready = simulation.render(frame) if wanted() else None
            if self._closed.wait(max(0.0, due - time.monotonic())):
                return
            if time.monotonic() - due > LONGEST_DELAY * period:
                due = time.monotonic()
            if abs(due_ns - _on_the_wall(due)) > 1e9 * LONGEST_DELAY * period:
                due_ns = _on_the_wall(due)
            yield _captured(simulation, frame, due_ns, ready)
            due, due_ns = due + period, due_ns + round(1e9 * period)

    def close(self) -> None:
        """End ``captures``."""
        self._closed.set()

    def _frames(self) -> Iterator[tuple[Simulation, int]]:
        """The frames of one performance after another, the next prepared in time for it."""
        current, self._first = self._first or self._perform(0), None
        ahead = round(PREPARED_AHEAD_S * self._options.frame_rate)
        with ThreadPoolExecutor(1, "simulator") as executor:
            for following in itertools.count(1):
                prepared: Future[Simulation] | None = None
                for frame in range(current.frames):
                    if self._options.loop and frame == max(current.frames - ahead, 0):
                        prepared = executor.submit(self._perform, following)
                    yield current, frame
                if prepared is None:
                    return
                current = prepared.result()

    def _perform(self, performance: int) -> Simulation:
        options = self._options
        simulation = simulate(
            options.interaction,
            options.participant,
            options.seed,
            options.frames,
            replace(CAMERAS[options.camera], frame_rate=options.frame_rate),
            performance,
        )
        simulation.prepare()
        return simulation


def _on_the_wall(moment: float) -> int:
    """What the wall clock reads at a moment (monotonic seconds), in nanoseconds: somebody may set
    it between two frames."""
    return time.time_ns() + round(1e9 * (moment - time.monotonic()))


def _captured(
    simulation: Simulation, frame: int, time_ns: int, ready: SensedFrame | None
) -> Captured:
    def pixels() -> Pixels:
        seen = ready or simulation.render(frame)
        return Pixels(seen.colour, seen.depth)

    label = label_message(
        simulation,
        frame,
        sequence=0,
        time_ns=time_ns,
        camera=UNNAMED_CAMERA,
        visible_fraction=ready.visible_fraction if ready else None,
    )
    return Captured(time_ns, 0, pixels, (person_message(simulation, frame),), (label,), SIMULATED)
