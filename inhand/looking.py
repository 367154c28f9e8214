"""A look at a running site: what the verbs topics, echo, rate and status share."""

import argparse
import contextlib
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, TypeVar

from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.inbox import Inbox, Received
from inhand_runtime.questions import ask
from inhand_runtime.session import Session, connected, open_session, subscribe, watch_instances
from inhand_runtime.settings import load_rig_file
from inhand_runtime.settings_errors import suggestion
from inhand_runtime.signals import set_on_signals
from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.keys import VERSION, Site, require_name
from inhand_schemas.messages import Health
from inhand_schemas.procedure import Procedure
from inhand_schemas.topics import BULK, HEALTH, TOPICS, AnyTopic, topic_of
from msgspec import Struct
from rich.console import Console

N = TypeVar("N", int, float)
Q = TypeVar("Q", bound=Struct)
R = TypeVar("R", bound=Struct)

QUEUE_BYTES = 64 << 20
QUEUE_SAMPLES = 10_000
IDLE_S = 0.1
UNREACHED = "it does not run, or cannot be reached from here"
"""Why an instance may be silent, as far as can be known from here."""
ANSWER_S = 2.0
"""Seconds in which an instance answers a request."""
FILE_WIDTH = 200
OTHER_VERSIONS = tuple(version for version in range(10) if version != VERSION)


class Look:
    """Samples of one rig as they arrive, without taking part in its work."""

    def __init__(
        self, session: Session, site: Site, stop: threading.Event, *, needs_hub: bool = False
    ) -> None:
        self.site = site
        self.skipped = 0
        self._stop = stop
        self._needs_hub = needs_hub
        self._session = session
        self._inbox = Inbox()
        self._subscribers: list[Any] = []

    def can_hear(self) -> bool:
        """Whether anything can arrive now: a client hears nothing while its hub is away."""
        return not self._needs_hub or bool(connected(self._session))

    def follow(self, topic: AnyTopic, name: str | None = None) -> None:
        """Let a topic arrive: one name of it, or all."""
        pattern = topic.pattern(self.site) if name is None else topic.key(self.site, name)
        lane = self._inbox.lane(samples=QUEUE_SAMPLES, size=QUEUE_BYTES, on_drop=self._skip)
        self._subscribers.append(subscribe(self._session, pattern, topic.delivery, lane.put))

    def follow_all(self) -> None:
        """Let every topic arrive, and what other versions of Inhand publish beside them."""
        for topic in TOPICS.values():
            self.follow(topic)
        lane = self._inbox.lane(samples=QUEUE_SAMPLES, size=QUEUE_BYTES, on_drop=self._skip)
        for version in OTHER_VERSIONS:
            pattern = self.site.pattern_of_version(version)
            self._subscribers.append(subscribe(self._session, pattern, BULK, lane.put))

    def follow_tokens(self, on_change: Callable[[str, str, bool], None]) -> None:
        """Call ``on_change(service, instance, lives)`` now and at each change, from any thread."""
        self._subscribers.append(watch_instances(self._session, self.site, on_change))

    def follow_health(self, on_health: Callable[[Health], None]) -> None:
        """Call ``on_health`` for each report from Zenoh's threads; it must return quickly."""

        def receive(sample: Received) -> None:
            with contextlib.suppress(MessageError, KeyFormatError):  # `inhand status` names them
                on_health(HEALTH.received(sample.key, sample.payload, sample.encoding))

        pattern = HEALTH.pattern(self.site)
        self._subscribers.append(subscribe(self._session, pattern, HEALTH.delivery, receive))

    def samples(self, seconds: float | None) -> Iterator[Received | None]:
        """What arrives within ``seconds`` (None = without end); None when nothing just did.

        Raises KeyboardInterrupt at Ctrl-C or SIGTERM: here, where no lock is held that Zenoh's
        threads would wait for.
        """
        end = None if seconds is None else time.monotonic() + seconds
        while end is None or time.monotonic() < end:
            if self._stop.is_set():
                raise KeyboardInterrupt
            yield self._inbox.get(IDLE_S)

    def ask(
        self,
        procedure: Procedure[Q, R],
        request: Q,
        complete: Callable[[list[R]], bool],
        seconds: float,
    ) -> list[R]:
        """Every reply to a request, asked again until they are complete, or for ``seconds``.

        A process that has just been connected does not hear the first time. Raises InhandError for
        one that fails.
        """
        end = time.monotonic() + seconds
        replies: list[R] = []
        while True:
            pattern, data = procedure.pattern(self.site), procedure.encode(request)
            try:
                replies += [
                    procedure.reply(*one) for one in ask(self._session, pattern, data, ANSWER_S)
                ]
            except MessageError as error:
                raise InhandError(str(error)) from None
            if complete(replies) or time.monotonic() > end:
                return replies
            if self._stop.wait(IDLE_S):
                raise KeyboardInterrupt

    def _skip(self, _key: str) -> None:
        self.skipped += 1


@contextlib.contextmanager
def open_look(config: Path | None) -> Iterator[Look]:
    """A look at the rig of a settings file; raises SettingsError or InhandError."""
    rig_file = load_rig_file(config)
    stop = threading.Event()
    with set_on_signals(stop), open_session(rig_file.zenoh) as session:
        site, needs_hub = Site(rig_file.realm, rig_file.rig), rig_file.zenoh.mode == "client"
        yield Look(session, site, stop, needs_hub=needs_hub)


def expected_instances(
    service: str, tables: Mapping[str, object], name: str | None
) -> tuple[str, ...]:
    """Names of the instances that must answer, all of the settings' tables or one; raises
    SettingsError for one that is not there."""
    if name is None:
        return tuple(tables)
    if tables and name not in tables:
        raise SettingsError(
            f"there is no table [{service}.{name}]" + suggestion(name, sorted(tables))
        )
    return (name,)


def add_looking_arguments(
    parser: argparse.ArgumentParser, seconds: float | None, why: str = "to look"
) -> None:
    """``--config``, and ``--seconds`` with its default and what they are for."""
    parser.add_argument("--config", type=Path, metavar="FILE", help="the rig's settings (TOML)")
    parser.add_argument(
        "--seconds",
        type=positive_number,
        default=seconds,
        metavar="S",
        help=f"how long {why} (default: {f'{seconds:g}' if seconds else 'until Ctrl-C'})",
    )


def positive_number(text: str) -> float:
    """Read an argument above zero; raises ArgumentTypeError, which argparse shows."""
    return _above(0.0, text, float, "a number above 0")


def positive_count(text: str) -> int:
    """Read an argument of 1 or more; raises ArgumentTypeError, which argparse shows."""
    return _above(0, text, int, "a whole number, 1 or more")


def seed_number(text: str) -> int:
    """Read a seed, 0 or more; raises ArgumentTypeError, which argparse shows."""
    return _above(-1, text, int, "a whole number, 0 or more")


def camera_name(text: str) -> str:
    """Read a camera's name; raises ArgumentTypeError, which argparse shows."""
    try:
        require_name("camera", text)
    except KeyFormatError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    return text


def _above(least: N, text: str, kind: Callable[[str], N], wanted: str) -> N:
    try:
        number = kind(text)
    except ValueError:
        number = least
    if not least < number < float("inf"):
        raise argparse.ArgumentTypeError(f"write {wanted}, not {text!r}")
    return number


def unreadable(sample: Received) -> str | None:
    """Why this release cannot read what was sent; None when it can."""
    try:
        topic, _ = topic_of(sample.key)
    except KeyFormatError as error:
        return str(error)
    if sample.encoding == topic.encoding:
        return None
    what = f"{sample.key} carries {sample.encoding!r}, and this release reads {topic.encoding!r}"
    if _without_version(sample.encoding) == _without_version(topic.encoding):
        return f"{what}: update the older side"
    return f"{what}: a program that is not Inhand's publishes there"


def _without_version(encoding: str) -> str:
    return encoding.rpartition(".v")[0]


def nothing_heard(site: Site, seconds: float | None) -> InhandError:
    """The line for a site that is silent."""
    within = "" if seconds is None else f" within {seconds:g} s"
    return InhandError(
        f"nothing answered from rig {site.rig!r} of realm {site.realm!r}{within}: start it with "
        "`inhand up`, or name its settings with --config"
    )


def stream_and_name(text: str) -> tuple[AnyTopic, str | None]:
    """Take ``STREAM`` or ``STREAM/NAME`` apart; raises SettingsError."""
    stream, _, name = text.partition("/")
    if stream not in TOPICS:
        raise SettingsError(f"there is no stream {stream!r}; there are: {', '.join(TOPICS)}")
    if not name:
        return TOPICS[stream], None
    try:
        require_name("name", name)
    except KeyFormatError as error:
        raise SettingsError(f"{text!r} is no STREAM/NAME: {error}") from None
    return TOPICS[stream], name


def output() -> Console:
    """Standard output for tables, in which whatever others sent is only text; what is no terminal
    takes wide lines."""
    console = Console(markup=False, emoji=False)
    if not console.is_terminal:
        console.width = FILE_WIDTH
    return console
