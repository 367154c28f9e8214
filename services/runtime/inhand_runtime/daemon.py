"""The life of a daemon: start, publish its health, stop on a signal.

``with running_daemon("tracker", settings) as daemon`` gives a service its publishers, its inbox
and the signal to stop; what a service does in between is its own.
"""

import contextlib
import logging
import threading
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.keys import Site
from inhand_schemas.messages import Health, Message
from inhand_schemas.procedure import Procedure
from inhand_schemas.topics import HEALTH, AnyTopic, Topic
from msgspec import Struct

from inhand_runtime.claims import Elders, claimed_name
from inhand_runtime.errors import InhandError
from inhand_runtime.health import HealthBoard
from inhand_runtime.inbox import UNBOUNDED, Inbox, Lane, Received
from inhand_runtime.known_member import require_known
from inhand_runtime.logs import configure_logs
from inhand_runtime.memory import give_libraries_back, give_memory_back, keep_what_started
from inhand_runtime.questions import Question, answer, ask
from inhand_runtime.service_manager import ServiceManager
from inhand_runtime.session import (
    Publisher,
    Session,
    Subscription,
    certified,
    connected,
    count_links,
    end_subscription,
    hear_namesakes,
    open_session,
    shown,
    subscribe,
    watch_instances,
)
from inhand_runtime.settings import Section, Settings, ZenohSettings
from inhand_runtime.signals import set_on_signals

log = logging.getLogger(__name__)

T = TypeVar("T", bound=Message)
Q = TypeVar("Q", bound=Struct)
R = TypeVar("R", bound=Struct)

HEALTH_PERIOD_S = 1.0
REPORTS_UNTIL_LONELY = 3
REPORTS_UNTIL_STARTED = 5
"""Number of reports after which what a start needed is no longer in use."""
REPORTS_UNTIL_TIDY = 60
"""Number of reports from one return of free memory to the next."""
NAMESAKE_LASTS_S = 3.0
NEWEST_SAMPLES = 4
EVERY_SAMPLES = 256


@dataclass(frozen=True, eq=False)
class Arrivals:
    """What arrives on a key or pattern, and the inbox's lane for it."""

    pattern: str
    handle: Subscription
    lane: Lane


class Daemon:
    """What a running service works with."""

    def __init__(
        self, session: Session, site: Site, service: str, instance: str, stop: threading.Event
    ) -> None:
        self.site = site
        self.instance = instance
        self.inbox = Inbox()
        self.manager = ServiceManager()
        self.health = HealthBoard(service, instance, on_round=self.manager.advanced)
        self.stop = stop
        self.given_way: str | None = None
        """Why this instance ends although nobody asked for it, if it does."""
        self._session = session
        self._arrivals: list[Arrivals] = []
        self._kept: list[Publisher[Any]] = []
        self._questions: list[Question] = []

    def publisher(self, topic: Topic[T], name: str) -> Publisher[T]:
        """A counted publisher of this site; the last value of a kept topic is repeated."""
        key = topic.key(self.site, name)
        publisher = Publisher(self._session, topic, key, self.health.published)
        if topic.delivery.kept:
            self._kept.append(publisher)
        return publisher

    @contextlib.contextmanager
    def shown_in(self, sites: Sequence[Site]) -> Iterator[list[Publisher[Health]]]:
        """Show this instance in other rigs as well until the block ends; what publishes its health
        there."""
        service, instance = self.health.service, self.instance
        with contextlib.ExitStack() as stack:
            for site in sites:
                stack.enter_context(shown(self._session, site.live_key(service, instance)))
            yield [
                Publisher(self._session, HEALTH, HEALTH.key(site, instance), self.health.published)
                for site in sites
            ]

    def repeat_kept(self) -> None:
        """Send the last values of all kept topics again."""
        for publisher in list(self._kept):
            publisher.repeat()

    def subscribe(
        self,
        topic: AnyTopic,
        name: str | None = None,
        *,
        samples: int | None = None,
        size: int = UNBOUNDED,
        wanted: Callable[[str], bool] | None = None,
    ) -> Arrivals:
        """Let a topic (one name of it, or all) arrive in the inbox, until it is unsubscribed.

        What comes on a key that is not ``wanted`` takes no room. ``samples`` and ``size`` (bytes)
        bound what may wait; without ``samples`` the topic's delivery does. The oldest beyond the
        bound is dropped and counted.
        """
        if samples is None:
            samples = NEWEST_SAMPLES if topic.delivery.readers == "newest" else EVERY_SAMPLES
        lane = self.inbox.lane(samples=samples, size=size, on_drop=self.health.overflowed)
        pattern = topic.pattern(self.site) if name is None else topic.key(self.site, name)

        def put(sample: Received) -> None:
            if wanted is None or wanted(sample.key):
                lane.put(sample)

        handle = subscribe(self._session, pattern, topic.delivery, put)
        arrivals = Arrivals(pattern, handle, lane)
        self._arrivals.append(arrivals)
        return arrivals

    def unsubscribe(self, arrivals: Arrivals) -> None:
        """Let a topic arrive no more: whoever publishes it sees that nobody listens any longer."""
        self._arrivals.remove(arrivals)
        end_subscription(arrivals.handle)
        self.inbox.remove(arrivals.lane)
        self.health.begin_anew(arrivals.pattern)

    def watch_instances(self, on_change: Callable[[str, str, bool], None]) -> Subscription:
        """Call ``on_change(service, instance, lives)`` for all who live now, and at each change.

        It is called from Zenoh's threads; keep the returned handle.
        """
        return watch_instances(self._session, self.site, on_change)

    def answer(self, procedure: Procedure[Q, R], on_request: Callable[[Q], R | None]) -> None:
        """Answer a procedure's requests from now on, from Zenoh's threads.

        ``on_request`` returns None for a request that is another instance's.
        """

        def receive(data: bytes) -> bytes | None:
            reply = on_request(procedure.request(data))
            return None if reply is None else procedure.encode(reply)

        own, shared = procedure.key(self.site, self.instance), procedure.shared_key(self.site)
        self._questions += [answer(self._session, key, receive) for key in (own, shared)]

    def ask(self, procedure: Procedure[Q, R], request: Q, timeout_s: float) -> list[R]:
        """Ask all instances that a procedure's request concerns; the replies that came in time.

        Raises InhandError for one that fails, and MessageError for a reply that is none.
        """
        pattern, data = procedure.pattern(self.site), procedure.encode(request)
        return [procedure.reply(*one) for one in ask(self._session, pattern, data, timeout_s)]

    def hear_namesakes(self, key: str) -> Subscription:
        """Note, as a trouble, that another process publishes on a key of this instance's own."""

        def note() -> None:
            self.health.trouble(
                f"namesake {key}",
                f"another process publishes on {key} as well: two instances have one name, and "
                "readers get both; stop one",
                lasts_s=NAMESAKE_LASTS_S,
            )

        return hear_namesakes(self._session, key, note)

    def give_way(self) -> None:
        """End, since an instance of the same name was up earlier."""
        self.given_way = (
            f"another {self.health.service} {self.instance} was up earlier in rig "
            f"{self.site.rig!r} of realm {self.site.realm!r}, and could not be seen when this one "
            "started: this one ends; give one of them another name"
        )
        self.health.trouble("elder", self.given_way)
        self.stop.set()

    def is_alone(self) -> bool:
        """Whether no other process is connected now."""
        return not connected(self._session)

    def certified(self) -> dict[str, list[str]]:
        """The common names of the certificates that others show now, with the host of each link."""
        return certified(self._session)

    def count_links(self) -> int:
        """How many links to others are up."""
        return count_links(self._session)

    def receive(self, timeout_s: float) -> Received | None:
        """The next sample of the inbox, or None; a main loop that calls it is seen to live."""
        self.health.came_round()
        return self.inbox.get(timeout_s)

    def decode(self, topic: Topic[T], sample: Received) -> T | None:
        """The sample's message; None when it is malformed, which is counted and logged."""
        try:
            message = topic.received(sample.key, sample.payload, sample.encoding)
        except (MessageError, KeyFormatError) as error:
            self.health.malformed(sample.key, error)
            return None
        self.health.received(sample.key, message.sequence if topic.gaps_are_losses else None)
        if not topic.delivery.kept:
            self.health.arrived(sample.key, sample.received_ns - message.time_ns)
        return message


def _nothing() -> None:
    """A service that needs nothing."""


@contextlib.contextmanager
def running_daemon(
    service: str,
    settings: Settings[Section],
    router: contextlib.AbstractContextManager[Session] | None = None,
    *,
    prepare: Callable[[], object] = _nothing,
    also_in: Sequence[Site] = (),
) -> Iterator[Daemon]:
    """Open the session, announce the instance, and publish its health until the block ends.

    ``router`` opens the session of a hub, which is reached by others and looks for nobody.
    ``prepare`` does what a service needs before it is announced, while its name is claimed; what it
    raises ends the start. It shows itself and its health in the rigs ``also_in`` too, as a hub that
    serves several.

    SIGTERM or SIGINT sets ``daemon.stop``; a second one ends the process at once. Raises
    SettingsError or InhandError when the session cannot be opened, and InhandError when an
    instance of that name lives already; at the end of the block also when one that was up earlier
    came into sight meanwhile, which sets ``daemon.stop``.
    """
    configure_logs(settings.log, settings.instance)
    stop = threading.Event()
    opened = open_session(settings.zenoh) if router is None else router
    with set_on_signals(stop), opened as session:
        site, instance = settings.site, settings.instance
        if router is None and settings.zenoh.joins_hub:
            require_known(session, settings, service, stop)
        with claimed_name(session, site, service, instance, stop, prepare) as elders:
            daemon = Daemon(session, site, service, instance, stop)
            keep_what_started()
            looks_for = settings.zenoh if router is None else None
            with _publishing_health(daemon, elders, looks_for, also_in):
                log.info("%s %s is up", service, instance)
                try:
                    yield daemon
                finally:
                    daemon.health.state = "stopping"
                    if daemon.stop.is_set():  # a hub that starts anew goes on
                        daemon.manager.stopping()
                    daemon.stop.set()
                    daemon.inbox.close()
        log.info("%s %s stopped", service, instance)
    if daemon.given_way is not None:
        raise InhandError(daemon.given_way)


@contextlib.contextmanager
def _publishing_health(
    daemon: Daemon, elders: Elders, settings: ZenohSettings | None, also_in: Sequence[Site]
) -> Iterator[None]:
    """Publish the health once a second, and a last time at the end of the block.

    Whoever publishes health under the same name is a namesake, and both say so.
    """
    publisher = daemon.publisher(HEALTH, daemon.instance)
    handle = daemon.hear_namesakes(publisher.key)
    finished = threading.Event()
    with daemon.shown_in(also_in) as others:
        reporter = threading.Thread(
            target=_report,
            args=(daemon, elders, [publisher, *others], finished, settings),
            name="health",
        )
        reporter.start()
        try:
            yield
        finally:
            finished.set()
            reporter.join()
            del handle


def _report(
    daemon: Daemon,
    elders: Elders,
    publishers: Sequence[Publisher[Health]],
    finished: threading.Event,
    settings: ZenohSettings | None,
) -> None:
    reports = 0
    while not finished.wait(HEALTH_PERIOD_S):
        if elders.stayed() and daemon.given_way is None:
            daemon.give_way()
        health = daemon.health.report()
        for publisher in publishers:
            publisher.put(health)
        daemon.manager.status("; ".join((health.state, *health.troubles)))
        daemon.repeat_kept()
        reports += 1
        if reports == REPORTS_UNTIL_LONELY and settings is not None and daemon.is_alone():
            log.warning("no other process is connected yet; %s", _where_to_meet(settings))
        if reports % REPORTS_UNTIL_TIDY == REPORTS_UNTIL_STARTED:
            give_memory_back()
        if reports == REPORTS_UNTIL_STARTED:
            give_libraries_back()
    health = daemon.health.report()
    for publisher in publishers:
        publisher.put(health)


def _where_to_meet(settings: ZenohSettings) -> str:
    if settings.mode == "client":
        return f"check the hub at {', '.join(settings.connect)}"
    return (
        f"those that run meet at zenoh.meeting = {settings.meeting}: check that all have the "
        "same, and that no foreign program holds that port"
    )
