"""The source ``replay``: a recording instead of a camera."""

import contextlib
import logging
import threading
import time
from collections.abc import Callable, Generator, Iterator, Mapping
from typing import Annotated, Any

from inhand_runtime.recording import RecordingError, read_recording
from inhand_runtime.settings import FilePath, Section
from inhand_runtime.settings_errors import explain
from inhand_runtime.source import QUIET_S, Captured, SourceError
from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.messages import CameraInfo
from inhand_schemas.topics import INFO, LABEL, RGBD, SKELETONS
from pydantic import Field, ValidationError

from inhand_capture.sources.moments import moments

log = logging.getLogger(__name__)

PLAYED_STREAMS = frozenset(topic.stream for topic in (RGBD, SKELETONS, LABEL))


LONGEST_DELAY_S = 0.5
"""Seconds late from which on playback goes on from now instead of hurrying after its times."""
LONGEST_STEP_S = 5.0
"""Longest pause between two moments, in recorded seconds: a longer one is a clock that was set, or
a time in which nothing was recorded."""


class ReplayOptions(Section):
    """``[capture.NAME.options]`` of a replay.

    ``rate`` 2 plays twice as fast, 0 as fast as possible; ``loop`` begins again at the end.
    ``camera`` chooses one of a recording of several.
    """

    file: FilePath
    rate: Annotated[float, Field(ge=0, allow_inf_nan=False)] = 1.0
    loop: bool = False
    camera: str | None = None


class ReplaySource:
    """Plays a recording with its original timing and capture times."""

    options_model = ReplayOptions

    @classmethod
    def check_options(cls, options: Mapping[str, Any]) -> None:
        """Raise SourceError for a recording that is not there, or cannot be played."""
        cls(options)

    def __init__(self, options: Mapping[str, Any]) -> None:
        try:
            self._options = ReplayOptions(**options)
        except ValidationError as error:
            raise SourceError(explain(error, None, ("options",), ReplayOptions)) from None
        self._closed = threading.Event()
        self._unreadable = 0
        self._camera, self._info = self._choose(self._cameras())

    @property
    def info(self) -> CameraInfo:
        """How the recorded camera saw."""
        return self._info

    def captures(self, wanted: Callable[[], bool]) -> Iterator[Captured | None]:
        """The recorded moments, each when it is due; raises SourceError for a damaged file.

        After a pause of the process, or where it cannot keep up, playback goes on from now: what
        was due meanwhile is not sent in a burst.
        """
        due: float | None = None
        while True:
            before_ns: int | None = None
            with contextlib.closing(self._moments()) as recorded:
                for captured in recorded:
                    # The clock starts at the first moment: reading up to it took a while.
                    due = time.monotonic() if due is None else due
                    due += self._played(self._step_s(before_ns, captured.time_ns))
                    before_ns = captured.time_ns
                    yield from self._wait_until(due)
                    if self._closed.is_set():
                        return
                    if time.monotonic() - due > LONGEST_DELAY_S:
                        due = time.monotonic()
                    yield captured
            if before_ns is None or due is None or not self._options.loop:
                return
            due += self._played(1 / self._info.frame_rate)

    def close(self) -> None:
        """End ``captures``."""
        self._closed.set()

    def _step_s(self, before_ns: int | None, time_ns: int) -> float:
        """Seconds from one moment to the next, bounded where the recorded clock was set."""
        step_s = 0.0 if before_ns is None else (time_ns - before_ns) / 1e9
        if step_s < -LONGEST_DELAY_S or step_s > LONGEST_STEP_S:
            log.warning(
                "%s: the recorded time jumps by %+.1f s, where the clock was set or nothing was "
                "recorded; playback goes on",
                self._options.file,
                step_s,
            )
        return min(max(step_s, 0.0), LONGEST_STEP_S)

    def _wait_until(self, due: float) -> Iterator[None]:
        while (rest := due - time.monotonic()) > 0.0:
            if self._closed.wait(min(rest, QUIET_S)):
                return
            if rest > QUIET_S:
                yield None

    def _played(self, seconds: float) -> float:
        """How long a recorded time span takes here."""
        return seconds / self._options.rate if self._options.rate else 0.0

    def _moments(self) -> Generator[Captured]:
        with self._explaining():
            yield from moments(
                read_recording(self._options.file, streams=PLAYED_STREAMS),
                self._camera,
                self._pass_over,
            )
        if self._unreadable:
            log.warning(
                "%s: %d messages cannot be read and were passed over",
                self._options.file,
                self._unreadable,
            )
            self._unreadable = 0

    def _pass_over(self, error: MessageError) -> None:
        if not self._unreadable:
            log.warning("%s: a message is passed over: %s", self._options.file, error)
        self._unreadable += 1

    def _cameras(self) -> dict[str, CameraInfo]:
        cameras: dict[str, CameraInfo] = {}
        with self._explaining():
            for recorded in read_recording(self._options.file, streams=(INFO.stream,)):
                cameras.setdefault(recorded.name, INFO.decode(recorded.payload))
        return cameras

    def _choose(self, cameras: dict[str, CameraInfo]) -> tuple[str, CameraInfo]:
        file, wish = self._options.file, self._options.camera
        names = ", ".join(sorted(cameras))
        if not cameras:
            raise SourceError(f"{file} holds no camera's info: choose another recording")
        if wish is None and len(cameras) > 1:
            raise SourceError(
                f"{file} holds several cameras; set options.camera to one of: {names}"
            )
        if wish is not None and wish not in cameras:
            raise SourceError(f"{file} holds no camera {wish!r}; there are: {names}")
        name = wish if wish is not None else next(iter(cameras))
        return name, cameras[name]

    @contextlib.contextmanager
    def _explaining(self) -> Iterator[None]:
        try:
            yield
        except RecordingError as error:
            raise SourceError(str(error)) from error
        except (MessageError, KeyFormatError) as error:
            raise SourceError(f"{self._options.file}: {error}") from error
