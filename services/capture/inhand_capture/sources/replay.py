"""The source ``replay``: a recording instead of a camera."""

import contextlib
import threading
import time
from collections.abc import Callable, Generator, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any

from inhand_runtime.recording import RecordingError, read_recording
from inhand_runtime.settings import Section
from inhand_runtime.settings_errors import explain
from inhand_runtime.source import Captured, SourceError
from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.messages import CameraInfo
from inhand_schemas.topics import INFO, LABEL, RGBD, SKELETONS
from pydantic import Field, ValidationError

from inhand_capture.sources.moments import moments

PLAYED_STREAMS = frozenset(topic.stream for topic in (RGBD, SKELETONS, LABEL))


class ReplayOptions(Section):
    """``[capture.NAME.options]`` of a replay.

    ``rate`` 2 plays twice as fast, 0 as fast as possible; ``loop`` begins again at the end.
    ``camera`` chooses one of a recording of several.
    """

    file: Path
    rate: Annotated[float, Field(ge=0, allow_inf_nan=False)] = 1.0
    loop: bool = False
    camera: str | None = None


class ReplaySource:
    """Plays a recording with its original timing and capture times."""

    def __init__(self, options: Mapping[str, Any]) -> None:
        try:
            self._options = ReplayOptions(**options)
        except ValidationError as error:
            raise SourceError(explain(error, None, ("options",), ReplayOptions)) from None
        self._closed = threading.Event()
        self._camera, self._info = self._choose(self._cameras())

    @property
    def info(self) -> CameraInfo:
        """How the recorded camera saw."""
        return self._info

    def captures(self, wanted: Callable[[], bool]) -> Iterator[Captured]:
        """The recorded moments, each when it is due; raises SourceError for a damaged file."""
        begin = time.monotonic()
        while True:
            offset = 0.0
            first_ns: int | None = None
            with contextlib.closing(self._moments()) as recorded:
                for captured in recorded:
                    first_ns = captured.time_ns if first_ns is None else first_ns
                    offset = self._played((captured.time_ns - first_ns) / 1e9)
                    if self._closed.wait(max(0.0, begin + offset - time.monotonic())):
                        return
                    yield captured
            if first_ns is None or not self._options.loop:
                return
            begin += offset + self._played(1 / self._info.frame_rate)

    def close(self) -> None:
        """End ``captures``."""
        self._closed.set()

    def _played(self, seconds: float) -> float:
        """How long a recorded time span takes here."""
        return seconds / self._options.rate if self._options.rate else 0.0

    def _moments(self) -> Generator[Captured]:
        with self._explaining():
            yield from moments(
                read_recording(self._options.file, streams=PLAYED_STREAMS), self._camera
            )

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
