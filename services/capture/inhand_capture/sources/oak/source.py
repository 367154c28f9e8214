"""The source ``oak``: pairs of colour and depth from an OAK camera, until it is lost."""

import logging
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from datetime import timedelta
from functools import partial
from typing import Any

from inhand_runtime.settings_errors import explain
from inhand_runtime.source import QUIET_S, Captured, SourceError, SourceLostError
from inhand_schemas.messages import CameraInfo
from pydantic import ValidationError

from inhand_capture.sources.oak.clock import epoch_offset
from inhand_capture.sources.oak.condition import pace_trouble
from inhand_capture.sources.oak.connection import Connection, connect
from inhand_capture.sources.oak.controls import CONTROLS
from inhand_capture.sources.oak.images import Frame, camera_info, frame_of, pixels_of
from inhand_capture.sources.oak.library import dai
from inhand_capture.sources.oak.options import OakOptions
from inhand_capture.sources.oak.pairing import Pair, Pairing
from inhand_capture.sources.oak.parameters import OAK

log = logging.getLogger(__name__)


class OakSource:
    """One device, opened by the constructor, which returns when the first pair has come."""

    options_model = OakOptions

    def __init__(
        self, options: Mapping[str, Any], connect: Callable[[OakOptions], Connection] = connect
    ) -> None:
        try:
            self._options = OakOptions(**options)
        except ValidationError as error:
            raise SourceError(explain(error, None, ("options",), OakOptions)) from None
        self._closed = threading.Event()
        self._closing = threading.Lock()
        self._released = False
        self._asked = float("-inf")
        self._troubles: Mapping[str, str] = {}
        self._number: int | None = None
        self._given = self._missed = 0
        self._connection = connect(self._options)
        try:
            self._start()
            first = self._first_pair()
            self._info = camera_info(
                first.colour, first.depth, self._options, self._connection.description
            )
        except BaseException:
            self.close()
            raise
        log.info("the camera is %s", self._connection.description)

    @property
    def info(self) -> CameraInfo:
        """How it sees, at the size of its images."""
        return self._info

    def captures(self, wanted: Callable[[], bool]) -> Iterator[Captured | None]:
        """The newest moment each time; raises SourceLostError when the device went away."""
        silent_since = quiet_since = time.monotonic()
        while not self._closed.is_set():
            pair = self._newest_pair()
            now = time.monotonic()
            if pair is not None:
                yield self._captured(pair)
                # The time that the reader took is not the camera's silence.
                silent_since = quiet_since = time.monotonic()
            elif self._closed.is_set():
                return
            elif now - silent_since > OAK.silence_s:
                raise SourceLostError(self._silence())
            elif now - quiet_since > QUIET_S:
                yield None
                quiet_since = now

    def troubles(self) -> Mapping[str, str]:
        """What is wrong with the device though moments come; asked for at most every few seconds,
        since the device answers over the same link."""
        now = time.monotonic()
        if now - self._asked > OAK.condition_s:
            self._asked = now
            self._troubles = self._ask()
        return self._troubles

    def control(self, options: Mapping[str, Any]) -> None:
        """Change exposure, focus, white balance or light; None makes one automatic.

        Raises SourceError for what cannot be changed while it runs, or has no such value.
        """
        if fixed := sorted(options.keys() - set(CONTROLS)):
            raise SourceError(
                f"{', '.join(fixed)} cannot be changed while it runs; what can: "
                + ", ".join(CONTROLS)
            )
        changed = {**self._options.model_dump(exclude_unset=True), **options}
        try:
            checked = OakOptions(**changed)
        except ValidationError as error:
            raise SourceError(explain(error, None, ("options",), OakOptions)) from None
        self._connection.control(
            checked, [name for name, value in options.items() if value is None]
        )
        self._options = checked

    def close(self) -> None:
        """Release the device, which then restarts by itself within seconds."""
        self._closed.set()
        with self._closing:
            if self._released:
                return
            self._released = True
            for release in (self._connection.pipeline.stop, self._connection.close):
                try:
                    release()
                except RuntimeError as error:  # a device that is gone cannot be closed in order
                    log.warning("closing the camera: %s", error)

    def _start(self) -> None:
        queue: dict[str, Any] = {"maxSize": OAK.queued_frames, "blocking": False}
        self._colour = self._connection.colour.createOutputQueue(**queue)
        self._depth = self._connection.depth.createOutputQueue(**queue)
        self._pairing: Pairing[Frame, Frame] = Pairing(self._options.frame_rate)
        self._last = {"colour": time.monotonic(), "depth": time.monotonic()}
        try:
            self._connection.pipeline.start()
        except RuntimeError as error:
            raise SourceError(f"the camera cannot start: {error}") from error

    def _first_pair(self) -> Pair[Frame, Frame]:
        end = time.monotonic() + OAK.first_pair_s
        while time.monotonic() < end:
            if (pair := self._newest_pair()) is not None:
                return pair
        raise SourceLostError(self._silence())

    def _newest_pair(self) -> Pair[Frame, Frame] | None:
        """Wait a little for frames; of several pairs that came meanwhile the newest counts."""
        pair: Pair[Frame, Frame] | None = None
        try:
            dai.MessageQueue.waitAny([self._colour, self._depth], timedelta(seconds=OAK.poll_s))
            for name, queue, take in (
                ("colour", self._colour, self._pairing.colour),
                ("depth", self._depth, self._pairing.depth),
            ):
                for message in queue.tryGetAll():
                    self._last[name] = time.monotonic()
                    pair = take(frame_of(message)) or pair
        except (dai.MessageQueue.QueueException, RuntimeError) as error:
            if self._closed.is_set():
                return None
            reason = self._connection.died() or f"the link to the camera broke ({error})"
            raise SourceLostError(f"{reason}; it is opened again") from error
        return pair

    def _captured(self, pair: Pair[Frame, Frame]) -> Captured:
        number = pair.colour.number
        self._missed += 0 if self._number is None else max(number - self._number - 1, 0)
        self._given += 1
        self._number = number
        offset_ns, reading_ns = epoch_offset()
        return Captured(
            time_ns=pair.colour.host_ns + offset_ns,
            time_uncertainty_ns=reading_ns + self._connection.clock_ns,
            pixels=partial(pixels_of, pair.colour, pair.depth),
            people=None,
        )

    def _silence(self) -> str:
        """Say which of the streams is silent, and what the device says of itself."""
        if (reason := self._connection.died()) is not None:
            return f"{reason}; it is opened again"
        now = time.monotonic()
        silent = [name for name, at in self._last.items() if now - at > OAK.silence_s]
        if not silent:
            return "the camera's colour and depth never belong together; it is opened again"
        return f"no {' and no '.join(silent)} came for {OAK.silence_s:g} s; it is opened again"

    def _ask(self) -> dict[str, str]:
        try:
            troubles = dict(self._connection.troubles())
        except RuntimeError as error:
            troubles = {"condition": f"the camera does not say how it is: {error}"}
        if (slow := pace_trouble(self._given, self._missed)) is not None:
            troubles["pace"] = slow
        self._given = self._missed = 0
        return troubles
