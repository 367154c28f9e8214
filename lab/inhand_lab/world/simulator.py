"""The source ``simulator``: somebody who uses an object before a camera, for ever if need be."""

import itertools
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from typing import Annotated, Any, Literal, Self

from inhand_runtime.settings import Section
from inhand_runtime.settings_errors import explain, suggestion
from inhand_runtime.source import QUIET_S, Captured, Pixels, SourceError
from inhand_runtime.wording import counted
from inhand_schemas.conventions import SIMULATED
from inhand_schemas.messages import CameraInfo
from pydantic import AfterValidator, Field, ValidationError, model_validator

from inhand_lab.sensing.cameras import CAMERAS, Camera
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.messages import camera_info, label_message, person_message
from inhand_lab.world.parameters import RIG_CAMERAS, ROAMING_VIEWS, USUAL_VIEWS
from inhand_lab.world.rigs import RigView, simulate_views
from inhand_lab.world.roaming import ROAMING_INTERACTIONS
from inhand_lab.world.simulation import Casting, SensedFrame, Simulation, simulate_cast
from inhand_lab.world.staging import Staging, staged_frames

UNNAMED_CAMERA = "simulator"
"""Name of the camera in labels, until capture puts its own in its place."""

LONGEST_DELAY = 0.25
"""Delay, in periods, beyond which the world stands still instead of hurrying after its time: on a
busy machine the simulator draws fewer frames, and none whose time is long past."""

PREPARED_AHEAD_S = 4.0
"""Time before its first frame at which the next performance is prepared, seconds: memory holds two
from then on."""

PREPARED_APART_S = 1.0
"""Seconds by which a camera of a rig prepares the next performance before the one of the number
below: all at once would leave no core to who works on their frames."""


def _known(interaction: str) -> str:
    if interaction not in INTERACTIONS:
        raise ValueError(f"nobody knows {interaction!r}" + suggestion(interaction, INTERACTIONS))
    return interaction


class SimulatorOptions(Section):
    """``[capture.NAME.options]`` of a simulator.

    ``frames`` make one performance; with ``loop`` the next follows it, each a fresh one. Of several
    ``cameras`` about the person this one is number ``view``, 0 the first: all that have the same
    options but that show the same, as the wall clock says, the first performance from ``start`` on,
    seconds since the epoch. With ``own_clock`` frames have the times of a clock that is not the
    host's.
    """

    interaction: Annotated[str, AfterValidator(_known)] = "drinkFromMug"
    camera: Literal["kinect", "oak_d"] = "kinect"
    participant: Annotated[int, Field(ge=0)] = 0
    seed: Annotated[int, Field(ge=0)] = 0
    frames: Annotated[int, Field(ge=1)] = 360
    frame_rate: Annotated[float, Field(gt=0, le=240)] = 30.0
    loop: bool = True
    roaming: bool = False
    cameras: Annotated[int, Field(ge=1, le=len(RIG_CAMERAS))] = 1
    view: Annotated[int, Field(ge=0)] = 0
    start: Annotated[float, Field(ge=0)] = 0.0
    own_clock: bool = False

    @model_validator(mode="after")
    def _possible(self) -> Self:
        if self.view >= self.cameras:
            raise ValueError(
                f"view is 0 to {self.cameras - 1} of {counted(self.cameras, 'camera')}"
            )
        if self.roaming and self.interaction not in ROAMING_INTERACTIONS:
            able = ", ".join(ROAMING_INTERACTIONS)
            raise ValueError(f"nobody walks about in {self.interaction!r}; people do in: {able}")
        if self.cameras > 1 and self.frames < 2:
            raise ValueError("several cameras need 2 frames or more: each has its own moments")
        if self.cameras > 1 and not self.loop and not self.start:
            raise ValueError("several cameras without loop need start, when it is performed")
        return self


class SimulatorSource:
    """A simulated participant before a simulated camera, in real time, with the truth."""

    options_model = SimulatorOptions

    def __init__(self, options: Mapping[str, Any]) -> None:
        try:
            self._options = SimulatorOptions(**options)
        except ValidationError as error:
            raise SourceError(explain(error, None, ("options",), SimulatorOptions)) from None
        self._closed = threading.Event()
        self._first: Simulation | None = None
        self._view: tuple[int, RigView] | None = None
        if self._options.cameras == 1:
            self._first = self._perform(0)
        else:
            number = self._staging().performance_at(time.time_ns())
            self._view = number, self._perform_before_rig(number)

    @property
    def info(self) -> CameraInfo:
        """How the simulated camera sees, and where it stands among others."""
        camera = CAMERAS[self._options.camera]
        placed = None if self._view is None else self._view[1].rig_from_camera
        return camera_info(camera.intrinsics, self._options.frame_rate, rig_from_camera=placed)

    def captures(self, wanted: Callable[[], bool]) -> Iterator[Captured | None]:
        """Frames when they are due, rendered before that if pixels are wanted."""
        return self._captures_alone(wanted) if self._view is None else self._in_step(wanted)

    def _captures_alone(self, wanted: Callable[[], bool]) -> Iterator[Captured]:
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

    def _in_step(self, wanted: Callable[[], bool]) -> Iterator[Captured | None]:
        """Frames of one camera of a rig when they are due by the wall clock, and none late."""
        assert self._view is not None
        for staged in staged_frames(self._staging(), self._perform_before_rig, self._view):
            simulation, frame = staged.view.simulation, staged.frame
            while (left_s := 1e-9 * (staged.due_ns - time.time_ns())) > QUIET_S:
                if self._closed.wait(0.5 * QUIET_S):
                    return
                yield None
            ready = simulation.render(frame) if wanted() else None
            left_s = 1e-9 * (staged.due_ns - time.time_ns())
            if self._closed.wait(max(0.0, left_s)):
                return
            yield _captured(simulation, frame, staged.stamp_ns, ready)

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
        simulation = simulate_cast(self._cast(performance), self._options.frames, self._camera())
        simulation.prepare()
        return simulation

    def _perform_before_rig(self, performance: int) -> RigView:
        options, cast = self._options, self._cast(performance)
        chosen = [options.view]
        (view,) = simulate_views(cast, options.frames, self._camera(), options.cameras, chosen)
        view.simulation.prepare()
        return view

    def _cast(self, performance: int) -> Casting:
        options = self._options
        views = ROAMING_VIEWS if options.roaming else USUAL_VIEWS
        who = options.interaction, options.participant, options.seed
        return Casting(*who, performance, views, roaming=options.roaming)

    def _camera(self) -> Camera:
        return replace(CAMERAS[self._options.camera], frame_rate=self._options.frame_rate)

    def _staging(self) -> Staging:
        options = self._options
        return Staging(
            round(1e9 * options.start),
            round(1e9 * options.frames / options.frame_rate),
            round(1e9 * (PREPARED_AHEAD_S + options.view * PREPARED_APART_S)),
            options.loop,
            options.own_clock,
        )


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
