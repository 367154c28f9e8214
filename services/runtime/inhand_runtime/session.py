"""Zenoh sessions, publishers, subscribers and liveliness tokens.

Peers meet without multicast: the first process of a rig takes the meeting address and the later
ones connect to it; gossip then connects each to all. When the one that holds the address goes
away, the next process that starts takes it and the others find it by retrying. Peers that lose each
other are brought together again (see ``reconnection``).
"""

import contextlib
import json
import os
import secrets
import time
from collections.abc import Callable, Iterator
from typing import Any, Generic, TypeVar

import zenoh
import zenoh.ext
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import Site, parse_live_key
from inhand_schemas.messages import Message
from inhand_schemas.topics import Delivery, Topic

from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.hub_access import require_client, why_closed
from inhand_runtime.inbox import Received
from inhand_runtime.lingering import close_at_once
from inhand_runtime.reconnection import Links, Reconnection
from inhand_runtime.settings import ZenohSettings
from inhand_runtime.zenoh_config import session_config

T = TypeVar("T", bound=Message)

Session = zenoh.Session

Subscription = zenoh.Subscriber[None] | zenoh.ext.AdvancedSubscriber[None]
"""A handle: what it subscribes to arrives as long as somebody keeps it."""

HEARTBEAT_S = 0.5
REPEAT_S = 1.0
"""Seconds between repetitions of a kept value: a subscriber that starts beside its publisher can
miss the first one for ever (see ``Publisher.repeat``)."""
MOST_KEPT_KEYS = 1024
"""Number of keys whose last kept value a subscription remembers, to pass no repetition on."""
LIVELINESS_TIMEOUT_S = 0.5
GO_BETWEEN = "60be60be60be"
"""The first digits of the id of a session that only brings others together."""
_LOG_VARIABLE, _NO_SETTINGS = "RUST_LOG", ",zenoh::api::session=info"

PRIORITIES = {
    "urgent": zenoh.Priority.REAL_TIME,
    "normal": zenoh.Priority.DATA,
    "bulk": zenoh.Priority.DATA_LOW,
}
CONGESTION = {
    "drop": zenoh.CongestionControl.DROP,
    "wait_for_first": zenoh.CongestionControl.BLOCK_FIRST,
}


@contextlib.contextmanager
def open_session(settings: ZenohSettings) -> Iterator[Session]:
    """A session that is closed at the end; raises SettingsError or InhandError within seconds."""
    log_what_is_asked_for()
    if settings.mode == "client":
        with _open_client(settings) as session, closing_at_once(session):
            yield session
        return
    with (
        _open_peer(settings) as session,
        closing_at_once(session),
        _reconnected(session, settings),
    ):
        yield session


def log_what_is_asked_for() -> None:
    """Let Zenoh log what the environment asks for, if anything, but no settings: passwords stand
    there."""
    asked = os.environ.get(_LOG_VARIABLE, "")
    if asked and not asked.endswith(_NO_SETTINGS):
        os.environ[_LOG_VARIABLE] = asked + _NO_SETTINGS
    zenoh.init_log_from_env_or("off")


def _open_client(settings: ZenohSettings) -> Session:
    if not settings.connect:
        raise SettingsError('zenoh.mode = "client" needs zenoh.connect, the addresses of hubs')
    require_client(settings)
    config = session_config(settings, listen=(), connect=settings.connect)
    try:
        return zenoh.open(config)
    except zenoh.ZError:
        raise InhandError(why_closed(settings)) from None


def _open_peer(settings: ZenohSettings) -> Session:
    with contextlib.suppress(zenoh.ZError):
        return zenoh.open(
            session_config(settings, (settings.meeting, *settings.listen), settings.connect)
        )
    listen = settings.listen or (_any_port(settings.meeting),)
    try:
        return zenoh.open(session_config(settings, listen, (settings.meeting, *settings.connect)))
    except zenoh.ZError:
        setting = "listen" if settings.listen else "meeting"
        raise SettingsError(
            f"cannot listen on {', '.join(listen)}: the port is in use, or the address is not "
            f"of this machine; change zenoh.{setting}"
        ) from None


@contextlib.contextmanager
def closing_at_once(session: Session) -> Iterator[None]:
    """Let links to those who stand still hold nobody up when they are closed (``lingering``)."""

    def opened(event: zenoh.LinkEvent) -> None:
        if event.kind == zenoh.SampleKind.PUT:
            close_at_once((str(event.link.src), str(event.link.dst)))

    with session.info.declare_link_events_listener(opened, history=True):
        yield


@contextlib.contextmanager
def _reconnected(session: Session, settings: ZenohSettings) -> Iterator[None]:
    """Connect a peer again with those whose link was closed, until the block ends."""
    reconnection = Reconnection(lambda: _links(session), lambda: _go_between(settings))

    def note(event: zenoh.TransportEvent) -> None:
        peer = str(event.transport.zid)
        if event.kind == zenoh.SampleKind.DELETE and not peer.startswith(GO_BETWEEN):
            reconnection.lose(peer)

    with session.info.declare_transport_events_listener(note), reconnection.running():
        yield


@contextlib.contextmanager
def _go_between(settings: ZenohSettings) -> Iterator[Callable[[], Links]]:
    config = session_config(settings, listen=(), connect=(settings.meeting, *settings.connect))
    config.insert_json5("id", json.dumps(GO_BETWEEN + secrets.token_hex(10)))
    config.insert_json5("open/return_conditions/connect_scouted", "false")
    with zenoh.open(config) as session:
        yield lambda: _links(session)


def _links(session: Session) -> Links:
    info = session.info
    others = frozenset(str(other) for other in (*info.peers_zid(), *info.routers_zid()))
    go_betweens = frozenset(one for one in others if one.startswith(GO_BETWEEN))
    return Links(others - go_betweens, go_betweens)


def _any_port(endpoint: str) -> str:
    return endpoint.rsplit(":", 1)[0] + ":0"


class Publisher(Generic[T]):
    """Publishes one topic under one name; ``kept`` topics hand the last value to late joiners.

    No reader holds a publisher up: what a stuck or slow one cannot take waits in its link's queue,
    and is then dropped; it sees that by the messages' numbers.
    """

    def __init__(
        self,
        session: Session,
        topic: Topic[T],
        key: str,
        on_put: Callable[[str], None],
    ) -> None:
        self.key = key
        self._topic = topic
        self._on_put = on_put
        self._last: bytes | None = None
        delivery = topic.delivery
        quality: dict[str, Any] = {
            "encoding": topic.encoding,
            "priority": PRIORITIES[delivery.priority],
            "congestion_control": CONGESTION[delivery.congestion],
        }
        self._publisher: zenoh.Publisher | zenoh.ext.AdvancedPublisher
        if not delivery.kept:
            self._publisher = session.declare_publisher(key, **quality)
            return
        self._publisher = zenoh.ext.declare_advanced_publisher(
            session,
            key,
            cache=zenoh.ext.CacheConfig(1),
            publisher_detection=True,
            sample_miss_detection=zenoh.ext.MissDetectionConfig(
                heartbeat=None, sporadic_heartbeat=HEARTBEAT_S
            ),
            **quality,
        )

    def put(self, message: T) -> None:
        """Encode and send."""
        payload = self._topic.encode(message)
        if self._topic.delivery.kept:
            self._last = payload
        self._publisher.put(payload)
        self._on_put(self.key)

    def repeat(self) -> None:
        """Send the last value of a kept topic again, to those who missed it; it is not counted.

        Zenoh's cache of the last value does not reach every subscriber: where a third process holds
        the meeting address, one that starts within seconds of its publisher may never get it.
        """
        if self._last is not None:
            self._publisher.put(self._last)

    def wanted(self) -> bool:
        """Whether anybody listens now; a kept topic is always wanted, for those to come."""
        if isinstance(self._publisher, zenoh.ext.AdvancedPublisher):
            return True
        status: Any = self._publisher.matching_status
        return bool(status.matching)


def subscribe(
    session: Session,
    pattern: str,
    delivery: Delivery,
    on_sample: Callable[[Received], None],
) -> Subscription:
    """Call ``on_sample`` from Zenoh's threads for what matches; keep the returned handle.

    ``on_sample`` must return quickly and never raise: give it a lane's ``put``. A kept value that
    is only repeated is not passed on, nor is the deletion of a key, which no publisher of ours
    sends.
    """
    kept: dict[str, bytes] = {}

    def receive(sample: zenoh.Sample) -> None:
        if sample.kind != zenoh.SampleKind.PUT:
            return
        key, payload = str(sample.key_expr), sample.payload.to_bytes()
        if delivery.kept:
            if kept.get(key) == payload:
                return
            if key in kept or len(kept) < MOST_KEPT_KEYS:
                kept[key] = payload
        on_sample(Received(key, payload, str(sample.encoding), time.time_ns()))

    if not delivery.kept:
        return session.declare_subscriber(pattern, receive)
    return zenoh.ext.declare_advanced_subscriber(
        session,
        pattern,
        receive,
        history=zenoh.ext.HistoryConfig(detect_late_publishers=True),
        recovery=zenoh.ext.RecoveryConfig(periodic_queries=None, heartbeat=True),
    )


def end_subscription(subscription: Subscription) -> None:
    """Let nothing of a subscription arrive any longer."""
    subscription.undeclare()  # type: ignore[no-untyped-call]


def session_id(session: Session) -> str:
    """What tells a session from all others: hexadecimal digits."""
    return str(session.info.zid())


def connected(session: Session) -> frozenset[str]:
    """The sessions of the processes that are connected now."""
    return _links(session).peers


def certified(session: Session) -> dict[str, list[str]]:
    """The common names of the certificates that connected processes show, with the host of each
    link."""
    hosts: dict[str, list[str]] = {}
    for link in session.info.links():
        if link.auth_identifier:
            hosts.setdefault(str(link.auth_identifier), []).append(str(link.dst).rpartition(":")[0])
    return hosts


def count_links(session: Session) -> int:
    """The number of links to other processes that are up."""
    return len(session.info.links())


def tokens(session: Session, pattern: str) -> set[str]:
    """The keys of the liveliness tokens that the connected processes, and this one, show now."""
    replies = session.liveliness().get(pattern, timeout=LIVELINESS_TIMEOUT_S)
    return {str(reply.ok.key_expr) for reply in replies if reply.ok is not None}


def hear_namesakes(session: Session, key: str, on_sample: Callable[[], None]) -> Subscription:
    """Call ``on_sample`` when another process publishes on a key that is this process's own."""

    def receive(_sample: zenoh.Sample) -> None:
        on_sample()

    return session.declare_subscriber(key, receive, allowed_origin=zenoh.Locality.REMOTE)


@contextlib.contextmanager
def shown(session: Session, key: str) -> Iterator[None]:
    """Show a liveliness token to all who look, until the block ends or the process dies."""
    with session.liveliness().declare_token(key):
        yield


def watch_tokens(
    session: Session, pattern: str, on_change: Callable[[str, bool], None]
) -> Subscription:
    """Call ``on_change(key, shown)`` for each token that is shown now, and at each change.

    It is called from Zenoh's threads, and must not raise; keep the returned handle.
    """

    def receive(sample: zenoh.Sample) -> None:
        on_change(str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT)

    return session.liveliness().declare_subscriber(pattern, receive, history=True)


def watch_instances(
    session: Session, site: Site, on_change: Callable[[str, str, bool], None]
) -> Subscription:
    """Call ``on_change(service, instance, lives)`` for all who live now, and at each change.

    It is called from Zenoh's threads; keep the returned handle.
    """

    def change(key: str, lives: bool) -> None:
        with contextlib.suppress(KeyFormatError):  # a foreign program's token is nobody of ours
            service, instance = parse_live_key(key)
            on_change(service, instance, lives)

    return watch_tokens(session, site.live_pattern(), change)
