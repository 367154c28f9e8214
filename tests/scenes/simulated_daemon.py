"""What a tracker's service needs of its daemon, with a clock that only messages and steps move."""

import threading
from dataclasses import dataclass
from typing import Any

from inhand_runtime.health import HealthBoard
from inhand_schemas.keys import Site
from inhand_schemas.messages import Message, ObjectPose
from inhand_schemas.topics import POSE, AnyTopic

SITE = Site()
SETTLES_S = 2.0
"""Seconds for which the service still runs after the last message."""


@dataclass(frozen=True)
class Sample:
    """A message as it came, and when."""

    key: str
    message: Message
    arrived: float


Due = tuple[float, AnyTopic, Message]
"""When a message arrives, in seconds, on which topic, and which."""
DueOf = tuple[float, AnyTopic, Message, str]
"""The same of one of several cameras."""


class SimulatedDaemon:
    """Hands out messages when they are due; ends when all were read. ``now`` is the time in
    seconds; whoever works moves it on."""

    def __init__(self, *messages: Due | DueOf) -> None:
        self.site, self.instance = SITE, "test"
        self.stop = threading.Event()
        self.health = HealthBoard("tracker", "test")
        self.now = 0.0
        self.subscribed: list[AnyTopic] = []
        self.poses: dict[str, list[ObjectPose]] = {}
        self.published: list[float] = []
        """When each pose was published."""
        self._samples = [
            Sample(topic.key(SITE, *camera or ["camera"]), message, due)
            for due, topic, message, *camera in sorted(messages, key=lambda one: one[0])
        ]
        self._end = max((sample.arrived for sample in self._samples), default=0.0) + SETTLES_S

    def clock(self) -> float:
        """The time in seconds."""
        return self.now

    def publisher(self, topic: AnyTopic, name: str) -> "Publications":
        """Keep what is published of an object."""
        assert topic is POSE
        return Publications(self, self.poses.setdefault(name, []))

    def subscribe(self, topic: AnyTopic, _name: str, **_bounds: int) -> None:
        """Note that a topic is wanted."""
        self.subscribed.append(topic)

    def receive(self, timeout_s: float) -> Sample | None:
        """The next sample that comes within the timeout."""
        if self._samples and self._samples[0].arrived <= self.now + timeout_s:
            sample = self._samples.pop(0)
            self.now = max(self.now, sample.arrived)
            return sample
        self.now += timeout_s
        if not self._samples and self.now >= self._end:
            self.stop.set()
        return None

    def decode(self, _topic: AnyTopic, sample: Sample) -> Any:
        """The sample's message."""
        return sample.message

    def dropped(self, topic: AnyTopic, camera: str = "camera") -> int:
        """How many messages of a topic the health counts as dropped."""
        return self.health.drops().get(topic.key(SITE, camera), 0)


class Publications:
    """Where one object's poses go."""

    def __init__(self, daemon: SimulatedDaemon, messages: list[ObjectPose]) -> None:
        self._daemon = daemon
        self._messages = messages

    def put(self, message: ObjectPose) -> None:
        """Keep a pose, and when it was published."""
        self._messages.append(message)
        self._daemon.published.append(self._daemon.now)
