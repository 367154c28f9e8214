"""The two processes between which frames go, by this project's sessions and by Zenoh as it comes.

The ways take turns frame by frame, so that other load meets all of them alike. Each end notes, by
the machine's steady clock, when a frame was put and when its bytes were there.
"""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from multiprocessing.synchronize import Event

import msgspec
from inhand_runtime.errors import InhandError
from inhand_runtime.inbox import Received
from inhand_runtime.session import Publisher, open_session, subscribe
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.keys import Site
from inhand_schemas.messages import RgbdFrame
from inhand_schemas.topics import RGBD

from inhand_lab.benchmarks.raw_zenoh import RawPublisher, RawSession, raw_session, subscribe_raw

OURS, RAW, RAW_SHARED = "ours", "Zenoh by itself", "Zenoh by itself, shared memory"
WAYS = (OURS, RAW, RAW_SHARED)
KEY = RGBD.key(Site(), "camera")
READY_S = 20.0
"""Seconds within which the ends find each other."""
ARRIVING_S = 1.0
"""Seconds for the last frames to arrive."""

Times = dict[str, dict[int, int]]
"""Nanoseconds of the steady clock, by way and number of the frame."""


@dataclass(frozen=True)
class Exchange:
    """What the ends agree on: an address for each way, the frame, how many, and how often."""

    addresses: Mapping[str, str]
    frame: RgbdFrame
    frames: int
    frame_rate: float


_ended: list[Event] = []
"""The event with which the sender tells the receiver that it has ended."""


def begin(ended: Event) -> None:
    """Take, in a new process, the event that both ends share."""
    _ended.append(ended)


def send(exchange: Exchange) -> Times:
    """Put each frame on every way in turns, and return when; raises InhandError."""
    try:
        with _publishers(exchange) as ways:
            _wait_for_readers(ways)
            return _send_in_turns(exchange, ways)
    finally:
        _ended[0].set()


def receive(exchange: Exchange) -> Times:
    """Take frames until the sender has ended, and return when the bytes of each were there."""
    came: Times = {way: {} for way in WAYS}

    def note(way: str, payload: bytes) -> None:
        now = time.monotonic_ns()
        came[way][RGBD.decode(payload).sequence] = now

    def note_ours(sample: Received) -> None:
        note(OURS, sample.payload)

    with ExitStack() as stack:
        ours = stack.enter_context(open_session(_settings(exchange)))
        handles: list[object] = [subscribe(ours, KEY, RGBD.delivery, note_ours)]
        for way in (RAW, RAW_SHARED):
            session = stack.enter_context(_raw_session(exchange, way, listens=False))
            handles.append(subscribe_raw(session, partial(note, way)))
        _ended[0].wait()
        time.sleep(ARRIVING_S)
    return came


@dataclass(frozen=True)
class _Way:
    """How a frame, given as a message and as its bytes, is put, and whether anybody listens."""

    put: Callable[[RgbdFrame, bytes], None]
    wanted: Callable[[], bool]


@contextmanager
def _publishers(exchange: Exchange) -> Iterator[dict[str, _Way]]:
    with ExitStack() as stack:
        session = stack.enter_context(open_session(_settings(exchange)))
        ours = Publisher(session, RGBD, KEY, lambda _: None)
        ways = {OURS: _Way(lambda message, _: ours.put(message), ours.wanted)}
        for way in (RAW, RAW_SHARED):
            raw = RawPublisher(stack.enter_context(_raw_session(exchange, way, listens=True)))
            ways[way] = _Way(partial(_put_bytes, raw), raw.wanted)
        yield ways


def _put_bytes(publisher: RawPublisher, _message: RgbdFrame, payload: bytes) -> None:
    publisher.put(payload)


def _send_in_turns(exchange: Exchange, ways: Mapping[str, _Way]) -> Times:
    names = list(ways)
    sent: Times = {name: {} for name in names}
    due_s, step_s = time.monotonic(), 1.0 / (exchange.frame_rate * len(ways))
    for number in range(exchange.frames):
        message = msgspec.structs.replace(exchange.frame, sequence=number)
        payload = RGBD.encode(message)
        for turn in range(len(names)):
            name = names[(number + turn) % len(names)]  # none comes always after the same one
            due_s += step_s
            time.sleep(max(0.0, due_s - time.monotonic()))
            sent[name][number] = time.monotonic_ns()
            ways[name].put(message, payload)
    return sent


def _wait_for_readers(ways: Mapping[str, _Way]) -> None:
    end_s = time.monotonic() + READY_S
    while missing := [name for name, way in ways.items() if not way.wanted()]:
        if time.monotonic() > end_s:
            raise InhandError(f"nobody takes frames by {missing[0]!r} within {READY_S:.0f} s")
        time.sleep(0.05)


def _settings(exchange: Exchange) -> ZenohSettings:
    return ZenohSettings(meeting=exchange.addresses[OURS])


def _raw_session(
    exchange: Exchange, way: str, *, listens: bool
) -> AbstractContextManager[RawSession]:
    address = exchange.addresses[way]
    return raw_session(address, listens=listens, shared_memory=way == RAW_SHARED)
