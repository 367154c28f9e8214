"""Estimates skeletons beside a source, in a thread of its own, so that no frame waits for them."""

import logging
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import Self

from inhand_runtime.errors import InhandError
from inhand_runtime.health import HealthBoard
from inhand_runtime.pixels import raw_colour, raw_depth
from inhand_runtime.source import Pixels
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, Skeletons
from msgspec import structs

from inhand_capture.estimation.estimator import EstimationError, SkeletonEstimator
from inhand_capture.estimation.found_person import FoundPerson

log = logging.getLogger(__name__)

TROUBLE = "skeletons"


@dataclass(frozen=True)
class Picture:
    """What skeletons are estimated of: a frame's pixels, its number, its time, and who sees it.

    ``found`` are the people in it where they were looked for already.
    """

    sequence: int
    time_ns: int
    pixels: Pixels
    estimator: SkeletonEstimator
    found: Sequence[FoundPerson] | None


class SkeletonStage:
    """Takes the newest frame whenever it is done with one; what it skips meanwhile is counted.

    Use it in a ``with`` block, which ends its thread.
    """

    def __init__(
        self,
        new_estimator: Callable[[CameraInfo], SkeletonEstimator],
        publish: Callable[[Skeletons], None],
        health: HealthBoard,
        key: str,
        convention: str | None = None,
    ) -> None:
        """``key`` is the one under which skipped frames are counted: that of the skeletons, whose
        ``convention`` is the network's."""
        self._new_estimator = new_estimator
        self._publish = publish
        self._health = health
        self._key = key
        self._convention = convention
        self._info: CameraInfo | None = None
        self._estimator: SkeletonEstimator | None = None
        self._changed = threading.Condition()
        self._newest: Picture | None = None
        self._failure: BaseException | None = None
        self._ended = False
        self._thread = threading.Thread(target=self._run, name="skeletons")

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        with self._changed:
            self._ended = True
            self._changed.notify()
        self._thread.join()

    def introduce(self, info: CameraInfo) -> None:
        """Take how the camera sees, from now on.

        Where it sees as before, as after a loss of the device, people keep their ids.
        """
        info = structs.replace(info, sequence=0, time_ns=0)
        if info != self._info:
            self._info = info
            self._estimator = self._new_estimator(info)

    def offer(
        self,
        sequence: int,
        time_ns: int,
        pixels: Pixels,
        found: Sequence[FoundPerson] | None = None,
    ) -> None:
        """Let skeletons of a frame be estimated, if no newer one comes before.

        ``found`` are the people in it, where they were looked for already. Raises InhandError when
        the thread has failed, which is a fault of the program.
        """
        if self._estimator is None:
            raise InhandError("a frame came before the camera's info")
        with self._changed:
            if self._failure is not None:
                raise InhandError(f"estimating skeletons failed: {self._failure}")
            if self._newest is not None:
                self._health.dropped(self._key)
            self._newest = Picture(sequence, time_ns, pixels, self._estimator, found)
            self._changed.notify()

    def _run(self) -> None:
        try:
            while (picture := self._next()) is not None:
                self._estimate(picture)
        except Exception as error:
            log.exception("estimating skeletons failed")
            with self._changed:
                self._failure = error

    def _next(self) -> Picture | None:
        """Wait for a frame and take it; None at the end."""
        with self._changed:
            self._changed.wait_for(lambda: self._ended or self._newest is not None)
            picture, self._newest = self._newest, None
            return None if self._ended else picture

    def _estimate(self, picture: Picture) -> None:
        """Publish the skeletons of one frame; a frame that has none to give is a trouble."""
        pixels = picture.pixels
        try:
            colour, depth = raw_colour(pixels.colour), raw_depth(pixels.depth)
            people = picture.estimator.estimate(colour, depth, picture.time_ns, picture.found)
        except (EstimationError, MessageError) as error:
            self._health.trouble(TROUBLE, str(error))
            return
        self._health.well(TROUBLE)
        self._publish(
            Skeletons(
                sequence=picture.sequence,
                time_ns=picture.time_ns,
                people=people,
                convention=self._convention,
            )
        )
