"""What a studio hears of its rig, and of each camera only while somebody looks at it."""

import threading
import time
from collections import Counter, deque
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from typing import Any, Literal

from inhand_runtime.daemon import Arrivals, Daemon
from inhand_runtime.inbox import Received
from inhand_runtime.roll import SILENT_AFTER_S, Roll
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.messages import CameraInfo, ObjectPose, Preview, RgbdFrame, Skeletons
from inhand_schemas.procedures import HYPOTHESES, HypothesesReply, HypothesesRequest
from inhand_schemas.topics import (
    HEALTH,
    INFO,
    POSE,
    PREVIEW,
    RGBD,
    SKELETONS,
    AnyTopic,
    Topic,
    topic_of,
)

from inhand_studio.picture import Picture

Pictures = Literal["frames", "previews"]
"""What of a camera's pictures is looked at: all of each frame, or small ones at a low rate."""

ANSWER_S = 2.0
"""Seconds in which a tracker answers."""
PICTURES_KEPT = 8
"""Number of newest pictures of a camera that wait for the poses that are estimated from them."""
SKELETONS_KEPT = 64
POSES_KEPT = 256
"""Number of newest poses that are kept: two seconds of several objects and people."""


@dataclass(frozen=True)
class CameraNews:
    """What came of one camera of late, each in the order of arrival."""

    pictures: tuple[Picture, ...] = ()
    skeletons: tuple[Skeletons, ...] = ()
    poses: tuple[ObjectPose, ...] = ()
    skeletons_at: float | None = None
    """When the last skeletons came, by the clock that nobody sets, in seconds."""
    poses_at: float | None = None


@dataclass
class _Camera:
    """What is kept of a camera that is looked at."""

    pictures: dict[Pictures, deque[Picture]] = field(
        default_factory=lambda: {
            "frames": deque(maxlen=PICTURES_KEPT),
            "previews": deque(maxlen=PICTURES_KEPT),
        }
    )
    skeletons: deque[Skeletons] = field(default_factory=lambda: deque(maxlen=SKELETONS_KEPT))
    poses: deque[ObjectPose] = field(default_factory=lambda: deque(maxlen=POSES_KEPT))
    skeletons_at: float | None = None
    poses_at: float | None = None


class Rig:
    """The rig as all tabs of a studio see it; thread-safe but for ``take``.

    Cameras' descriptions and the processes' health come always; skeletons, poses and pictures of a
    camera come while anybody looks at it, once for all who do.
    """

    def __init__(self, daemon: Daemon) -> None:
        self.roll = Roll(patience_s=SILENT_AFTER_S)
        self._daemon = daemon
        self._changed = threading.Condition()
        self._news = 0
        self._infos: dict[str, CameraInfo] = {}
        self._cameras: dict[str, _Camera] = {}
        self._looks: Counter[tuple[str, str | None]] = Counter()
        self._arrivals: dict[tuple[str, str | None], Arrivals] = {}
        self._looking = threading.Lock()
        daemon.subscribe(INFO)
        daemon.subscribe(HEALTH)
        self._tokens = daemon.watch_instances(self.roll.change)

    @property
    def name(self) -> str:
        """The rig's name."""
        return self._daemon.site.rig

    def is_alone(self) -> bool:
        """Whether no other process is connected."""
        return self._daemon.is_alone()

    def cameras(self) -> dict[str, CameraInfo]:
        """The cameras that have described themselves, by their names."""
        with self._changed:
            return dict(sorted(self._infos.items()))

    @contextmanager
    def looking(self, camera: str, pictures: Pictures | None) -> Iterator[None]:
        """Let skeletons, poses and, if any, pictures of a camera come until the block ends."""
        wanted: list[tuple[AnyTopic, str | None]] = [(POSE, None), (SKELETONS, camera)]
        if pictures is not None:
            wanted.append((RGBD if pictures == "frames" else PREVIEW, camera))
        with ExitStack() as held:
            for topic, name in wanted:
                held.enter_context(self._arriving(topic, name))
            yield

    def heard(self, camera: str, pictures: Pictures | None) -> CameraNews:
        """What came of a camera of late."""
        with self._changed:
            kept = self._cameras.get(camera)
            if kept is None:
                return CameraNews()
            return CameraNews(
                () if pictures is None else tuple(kept.pictures[pictures]),
                tuple(kept.skeletons),
                tuple(kept.poses),
                kept.skeletons_at,
                kept.poses_at,
            )

    def hypotheses(self) -> list[HypothesesReply]:
        """Ask the trackers what they consider; what those who track a frame within a second or so
        reply. Raises InhandError or MessageError; from any thread."""
        return self._daemon.ask(HYPOTHESES, HypothesesRequest(), ANSWER_S)

    def wait(self, news: int, timeout_s: float) -> int:
        """Wait until more has come than at ``news``, or for a time; returns the next ``news``."""
        with self._changed:
            self._changed.wait_for(lambda: self._news != news, timeout_s)
            return self._news

    def take(self, sample: Received) -> None:
        """Keep what a sample of the daemon's inbox says; for the main loop alone."""
        try:
            topic, parsed = topic_of(sample.key)
        except KeyFormatError as error:
            self._daemon.health.malformed(sample.key, error)
            return
        if topic is HEALTH:
            if (health := self._daemon.decode(HEALTH, sample)) is not None:
                self.roll.hear(health)
            return
        if topic is INFO:
            if (info := self._daemon.decode(INFO, sample)) is not None:
                with self._changed:
                    self._infos[parsed.name] = info
            return
        if topic is POSE or self._is_looked_at(topic, parsed.name):
            any_topic: Topic[Any] = topic
            message = self._daemon.decode(any_topic, sample)
            if message is not None:
                self._keep(parsed.name, message, time.monotonic())

    def _keep(self, name: str, message: object, now: float) -> None:
        with self._changed:
            camera = self._cameras.get(message.camera if isinstance(message, ObjectPose) else name)
            if camera is None:
                return
            if isinstance(message, RgbdFrame):
                camera.pictures["frames"].append(Picture(message, now))
            elif isinstance(message, Preview):
                camera.pictures["previews"].append(Picture(message, now))
            elif isinstance(message, Skeletons):
                camera.skeletons.append(message)
                camera.skeletons_at = now
            elif isinstance(message, ObjectPose):
                camera.poses.append(message)
                camera.poses_at = now
            self._news += 1
            self._changed.notify_all()

    def _is_looked_at(self, topic: AnyTopic, name: str) -> bool:
        return (topic.stream, name) in self._looks

    @contextmanager
    def _arriving(self, topic: AnyTopic, name: str | None) -> Iterator[None]:
        """Let a topic arrive while anybody looks at it."""
        key = topic.stream, name
        with self._looking:
            self._looks[key] += 1
            if self._looks[key] == 1:
                if topic is SKELETONS and name is not None:
                    with self._changed:
                        self._cameras[name] = _Camera()
                self._arrivals[key] = self._daemon.subscribe(topic, name)
        try:
            yield
        finally:
            with self._looking:
                self._looks[key] -= 1
                if not self._looks[key]:
                    del self._looks[key]
                    self._daemon.unsubscribe(self._arrivals.pop(key))
                    self._forget(topic, name)

    def _forget(self, topic: AnyTopic, name: str | None) -> None:
        """Forget what came on a key that nobody looks at any longer."""
        if name is None:
            return
        with self._changed:
            if topic is SKELETONS:
                del self._cameras[name]
            elif (camera := self._cameras.get(name)) is not None:
                camera.pictures["frames" if topic is RGBD else "previews"].clear()
