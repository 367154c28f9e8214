"""The two processes between which the messages of rigs go, by way of a hub or to recorders.

One has a session for each member that publishes, the other one for each that reads. A message bears
the time at which it was put; the reader notes how old it is when its bytes are there.
"""

import heapq
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from multiprocessing.synchronize import Event
from typing import Any

import msgspec
import psutil
from inhand_runtime.errors import InhandError
from inhand_runtime.inbox import Received
from inhand_runtime.session import Publisher, Subscription, open_session, subscribe
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.keys import Site
from inhand_schemas.messages import Message
from inhand_schemas.topics import POSE, PREVIEW, RGBD, SKELETONS, TOPICS, AnyTopic

PUBLISHED = {"camera": (RGBD, SKELETONS, PREVIEW), "tracker": (POSE,)}
"""What members publish, by role."""
READ = {
    "tracker": (RGBD, SKELETONS),
    "recorder": (RGBD, SKELETONS, PREVIEW, POSE),
    "viewer": (SKELETONS, PREVIEW, POSE),
}
"""What members read, by role."""
READY_S = 60.0
"""Seconds within which all members have joined."""
ARRIVING_S = 1.0
"""Seconds for the last messages to arrive."""

Delays = dict[tuple[int, str, str], list[float]]
"""Milliseconds that messages were under way, by rig, stream and the reader's role."""


@dataclass(frozen=True)
class RigEnds:
    """A rig: its keys, and how each member reaches its hub, by role, which is its name too."""

    site: Site
    members: Mapping[str, ZenohSettings]


@dataclass(frozen=True)
class Stream:
    """What is sent of a topic, how often a second, and how many seconds after the frame."""

    message: Message
    rate: float
    after_s: float = 0.0


@dataclass(frozen=True)
class Load:
    """What the ends agree on: the rigs, what each publishes by topic's stream, seconds before those
    that count, seconds that count, and the processes whose cost is measured."""

    rigs: tuple[RigEnds, ...]
    streams: Mapping[str, Stream]
    warming_s: float
    measured_s: float
    processes: tuple[int, ...]

    def first(self, stream: str) -> int:
        """Number of a stream's first message that counts."""
        return round(self.streams[stream].rate * self.warming_s)


@dataclass(frozen=True)
class Sent:
    """Number of messages that count by rig and stream, and while they were sent: the processor time
    of the measured processes and the time that passed, in seconds, their memory at the end, in MB,
    and the machine's busy share."""

    messages: Mapping[tuple[int, str], int]
    cpu_s: float
    passed_s: float
    mb: float
    busy: float


_ended: list[Event] = []
"""The event with which the sender tells the receiver that it has ended."""


def begin(ended: Event) -> None:
    """Take, in a new process, the event that both ends share."""
    _ended.append(ended)


def send(load: Load) -> Sent:
    """Put the messages of all rigs, each when it is due; raises InhandError."""
    try:
        with _publishers(load) as publishers:
            _wait_for_readers(publishers)
            return _send_when_due(load, publishers)
    finally:
        _ended[0].set()


def receive(load: Load) -> Delays:
    """Take messages until the sender has ended."""
    delays: Delays = {}
    with ExitStack() as stack:
        handles: list[Subscription] = []
        for number, rig in enumerate(load.rigs):
            for role, topics in READ.items():
                session = stack.enter_context(open_session(rig.members[role]))
                for topic in topics:
                    rows = delays.setdefault((number, topic.stream, role), [])
                    note = partial(_note, topic, load.first(topic.stream), rows)
                    handles.append(
                        subscribe(session, topic.pattern(rig.site), topic.delivery, note)
                    )
        _ended[0].wait()
        time.sleep(ARRIVING_S)
    return delays


def stand_still(rig: RigEnds, role: str, reads: Event) -> None:
    """Read all that a member may, say so, and go on until this process is ended."""
    with open_session(rig.members[role]) as session:
        came = [
            subscribe(session, topic.pattern(rig.site), topic.delivery, lambda _: reads.set())
            for topic in TOPICS.values()
        ]
        while came:
            time.sleep(1.0)


def _note(topic: AnyTopic, first: int, rows: list[float], sample: Received) -> None:
    message = topic.decode(sample.payload)
    if message.sequence >= first:
        rows.append((sample.received_ns - message.time_ns) / 1e6)


Publishers = dict[tuple[int, str], Publisher[Any]]


@contextmanager
def _publishers(load: Load) -> Iterator[Publishers]:
    with ExitStack() as stack:
        publishers: Publishers = {}
        for number, rig in enumerate(load.rigs):
            for role, topics in PUBLISHED.items():
                session = stack.enter_context(open_session(rig.members[role]))
                for topic in topics:
                    if topic.stream not in load.streams:
                        continue
                    key = topic.key(rig.site, role)
                    publishers[number, topic.stream] = Publisher(session, topic, key, _uncounted)
        yield publishers


def _uncounted(_key: str) -> None:
    """What is put is counted by who puts it."""


def _wait_for_readers(publishers: Publishers) -> None:
    end_s = time.monotonic() + READY_S
    while missing := [place for place, one in publishers.items() if not one.wanted()]:
        if time.monotonic() > end_s:
            raise InhandError(f"nobody reads {missing[0][1]} of rig {missing[0][0]}")
        time.sleep(0.1)


def _send_when_due(load: Load, publishers: Publishers) -> Sent:
    start = time.monotonic()
    counting_from, end = start + load.warming_s, start + load.warming_s + load.measured_s
    # Rigs are spread over the time of a frame: their cameras do not know each other.
    due = [
        (start + number / len(load.rigs) / one.rate + one.after_s, number, stream)
        for number, stream in publishers
        for one in [load.streams[stream]]
    ]
    heapq.heapify(due)
    numbers: Counter[tuple[int, str]] = Counter()
    measured, before = [psutil.Process(one) for one in load.processes], None
    while (next_at := due[0][0]) < end:
        if before is None and next_at >= counting_from:
            before = _processor_time(measured), time.monotonic(), psutil.cpu_percent()
        time.sleep(max(0.0, next_at - time.monotonic()))
        at, number, stream = due[0]
        one = load.streams[stream]
        heapq.heapreplace(due, (at + 1.0 / one.rate, number, stream))
        sequence = numbers[number, stream]
        numbers[number, stream] += 1
        publishers[number, stream].put(
            msgspec.structs.replace(one.message, sequence=sequence, time_ns=time.time_ns())
        )
    if before is None:
        raise InhandError("no message was due in the time that counts")
    return Sent(
        {place: count - load.first(place[1]) for place, count in numbers.items()},
        _processor_time(measured) - before[0],
        time.monotonic() - before[1],
        sum(one.memory_info().rss for one in measured) / 1e6,
        psutil.cpu_percent() / 100.0,
    )


def _processor_time(processes: Sequence[psutil.Process]) -> float:
    times = [one.cpu_times() for one in processes]
    return sum(one.user + one.system for one in times)
