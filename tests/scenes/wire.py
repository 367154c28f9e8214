"""The test's own ear and mouth on a rig's keys."""

import contextlib
import socket
import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Self, TypeVar

import psutil
import zenoh
from inhand_runtime.inbox import Received
from inhand_runtime.session import Publisher, Subscription, open_session, subscribe
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.keys import Site
from inhand_schemas.messages import Message
from inhand_schemas.topics import AnyTopic, Topic

T = TypeVar("T", bound=Message)


@dataclass
class Wire:
    """A session with subscriptions that last as long as it."""

    session: zenoh.Session
    site: Site = field(default_factory=Site)
    _subscriptions: list[Subscription] = field(default_factory=list)

    @classmethod
    @contextlib.contextmanager
    def at(cls, meeting: str) -> Iterator[Self]:
        """A peer at this meeting address."""
        with open_session(ZenohSettings(meeting=meeting)) as session:
            yield cls(session)

    def hear(self, topic: AnyTopic) -> list[Received]:
        """A list that grows by what is published from now on."""
        heard: list[Received] = []
        self._subscriptions.append(
            subscribe(self.session, topic.pattern(self.site), topic.delivery, heard.append)
        )
        return heard

    def publisher(self, topic: Topic[T], name: str) -> Publisher[T]:
        """A publisher that counts nothing."""
        return Publisher(self.session, topic, topic.key(self.site, name), lambda _key: None)

    def knows(self, count: int) -> bool:
        """Whether that many other processes are connected now."""
        return len(self.session.info.peers_zid()) >= count

    def live(self) -> list[str]:
        """The instances that announce themselves now, as ``service/instance``."""
        replies = self.session.liveliness().get(self.site.live_pattern())
        keys = [str(reply.ok.key_expr) for reply in replies if reply.ok is not None]
        return sorted("/".join(key.split("/")[-2:]) for key in keys)


def lingering_s() -> list[int]:
    """Seconds that each connected socket of this process lingers when it is closed."""
    found = []
    for one in psutil.Process().net_connections("tcp"):
        if one.raddr:
            own = socket.socket(fileno=one.fd)
            try:
                value = own.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, 8)
            finally:
                own.detach()
            on, seconds = struct.unpack("ii", value)
            found.append(seconds if on else 0)
    return found
