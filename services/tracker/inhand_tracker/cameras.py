"""What a live tracker sees of one camera: its messages, frame by frame."""

from abc import ABC, abstractmethod
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

from inhand_runtime.camera_infos import InfoWatch
from inhand_runtime.daemon import Daemon
from inhand_runtime.inbox import UNBOUNDED, Received
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, Person, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, RGBD, SKELETONS

from inhand_tracker.frames import camera_frame, frame_image, source_of
from inhand_tracker.geometry.image import Image
from inhand_tracker.live.moments import Moment, Moments
from inhand_tracker.people.watching import CameraFrame
from inhand_tracker.wire.conversion import Need
from inhand_tracker.wire.poses import SourceFrame

MOST_WAITING = 256
"""Number of skeletons that may arrive during one step and still count for the body's movement."""
QUEUE_BYTES = 512 * 2**20
"""Bytes of skeletons, and of frames, that may wait where every frame matters; beyond them the
oldest are dropped."""


@dataclass(frozen=True)
class Bodies:
    """The people of a moment that is skipped."""

    people: Sequence[Person]
    time_ns: int


@dataclass(frozen=True)
class LiveFrame:
    """A moment's people and images as watchers take them, and of which frame its poses are."""

    people: Sequence[Person]
    frame: CameraFrame
    source: SourceFrame


class Cameras(ABC):
    """The cameras of a tracker; who asks works on one moment after the other."""

    @property
    @abstractmethod
    def period_s(self) -> float:
        """Seconds from one moment to the next."""

    @abstractmethod
    def take(self, sample: Received, now: float) -> None:
        """Keep what a message brings until its moment is worked on."""

    @abstractmethod
    def wait_s(self, now: float) -> float:
        """Seconds until there is a moment, if nothing arrives."""

    @abstractmethod
    def decided(self) -> bool:
        """Whether the next moment has nothing to wait for, whatever comes."""

    @abstractmethod
    def next(self, now: float) -> Sequence[Bodies] | None:
        """Go on to the next moment; return those before it that are skipped, oldest first. None
        while there is none."""

    @abstractmethod
    def decode_ahead(self) -> None:
        """Decode what waits for the rest of its moment, while there is nothing else to do."""

    @abstractmethod
    def look(self, effort: float) -> LiveFrame:
        """Decode the moment that ``next`` went to, as far as that was not done ahead; it is worth a
        share of the usual work."""

    @abstractmethod
    def note_unused(self, skipped: int = 0) -> None:
        """Count in the health what came and was not used since the last time, with so many moments
        that were skipped."""

    @abstractmethod
    def leave(self) -> None:
        """Count all that waits as unused, at the end."""


class OneCamera(Cameras):
    """One camera, whose frame of reference is the poses'."""

    def __init__(
        self, daemon: Daemon, camera: str, needs: Collection[Need], *, every: bool
    ) -> None:
        self._daemon = daemon
        self._camera = camera
        self._needs = needs
        self._infos = InfoWatch(daemon.health)
        self._info: CameraInfo | None = None
        self._moments: Moments[Skeletons, RgbdFrame] = Moments(pixels=bool(needs), every=every)
        self._moment: Moment[Skeletons, RgbdFrame] | None = None
        self._keys = keys_of(daemon, camera)
        subscribe(daemon, camera, pixels=bool(needs), every=every)

    @property
    def period_s(self) -> float:
        return self._moments.period_s

    def take(self, sample: Received, now: float) -> None:
        self._infos.check(now)
        if sample.key == self._keys[INFO]:
            if (info := self._daemon.decode(INFO, sample)) is not None:
                self._info = info
                self._infos.note(INFO.stream, self._camera, now)
        elif sample.key == self._keys[RGBD]:
            if (frame := self._daemon.decode(RGBD, sample)) is not None:
                self._infos.note(RGBD.stream, self._camera, now)
                self._moments.add_frame(frame.sequence, frame, sample.arrived)
        elif (skeletons := self._daemon.decode(SKELETONS, sample)) is not None:
            self._moments.add_skeleton(skeletons.sequence, skeletons, sample.arrived)

    def wait_s(self, now: float) -> float:
        return self._moments.wait_s(now)

    def decided(self) -> bool:
        return self._moments.decided()

    def next(self, now: float) -> Sequence[Bodies] | None:
        self._moment = self._moments.next(now)
        if self._moment is None:
            return None
        return [Bodies(one.people, one.time_ns) for one in self._moment.skipped]

    def decode_ahead(self) -> None:
        """Nothing: a frame is the last that its moment waits for."""

    def look(self, effort: float) -> LiveFrame:
        assert self._moment is not None
        skeletons = self._moment.skeleton
        image = decoded(self._daemon, self._camera, self._moment.frame, self._info, self._needs)
        return LiveFrame(
            skeletons.people,
            camera_frame(skeletons, image, self._info, effort),
            source_of(skeletons, self._camera, self._info),
        )

    def note_unused(self, skipped: int = 0) -> None:
        frames = self._moments.take_unused_frames()
        count_unused(self._daemon, self._camera, skipped, frames)

    def leave(self) -> None:
        self.note_unused(self._moments.leave())


def keys_of(daemon: Daemon, camera: str) -> dict[Any, str]:
    """Return the keys of a camera's info, frames and skeletons, by topic."""
    return {topic: topic.key(daemon.site, camera) for topic in (INFO, RGBD, SKELETONS)}


def subscribe(daemon: Daemon, camera: str, *, pixels: bool, every: bool) -> None:
    """Let a camera's messages arrive: the newest, or all as far as there is memory."""
    waiting: dict[str, Any] = {"samples": MOST_WAITING}
    frames: dict[str, Any] = {}
    if every:
        waiting = frames = {"samples": UNBOUNDED, "size": QUEUE_BYTES}
    daemon.subscribe(INFO, camera)
    daemon.subscribe(SKELETONS, camera, **waiting)
    if pixels:
        daemon.subscribe(RGBD, camera, **frames)


def decoded(
    daemon: Daemon,
    camera: str,
    frame: RgbdFrame | None,
    info: CameraInfo | None,
    needs: Collection[Need],
) -> Image | None:
    """Decode what is needed of a camera's frame; None without it, and where it is damaged."""
    try:
        return frame_image(frame, info, needs)
    except MessageError as error:
        daemon.health.malformed(RGBD.key(daemon.site, camera), error)
        return None


def count_unused(daemon: Daemon, camera: str, skeletons: int, frames: int) -> None:
    """Count a camera's skeletons that are not tracked and frames that go unused."""
    for topic, count in ((SKELETONS, skeletons), (RGBD, frames)):
        if count:
            daemon.health.dropped(topic.key(daemon.site, camera), count)
