"""Watches what a rig publishes, and says how it comes back after a fault."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from inhand_runtime.inbox import Received
from inhand_runtime.session import Session, Subscription, end_subscription, subscribe
from inhand_schemas.errors import MessageError, UnknownVersionError
from inhand_schemas.keys import Site
from inhand_schemas.topics import HEALTH, POSE, SKELETONS, AnyTopic
from inhand_tracker.geometry.arrays import Array

from inhand_lab.chaos.host import HostClock
from inhand_lab.chaos.parameters import DEFAULT_CHAOS, ChaosParameters


@dataclass(frozen=True)
class Arrivals:
    """Messages of a stream in the order in which they came: when they were ``captured`` (N,) and
    when they ``came`` (N,), both in seconds since the epoch by this machine's clock, and the
    ``stamps`` (N,) that they bear, in seconds by the rig's."""

    captured: Array
    came: Array
    stamps: Array

    @property
    def ages(self) -> Array:
        """How old each was when it came (N,), in seconds."""
        return self.came - self.captured

    def between(self, start: float, end: float) -> "Arrivals":
        """Those that came in a span of time."""
        chosen = (self.came >= start) & (self.came < end)
        return Arrivals(self.captured[chosen], self.came[chosen], self.stamps[chosen])


class Watch:
    """Takes note of each skeleton and each pose of a rig as it comes."""

    def __init__(self, clock: HostClock) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._malformed: dict[str, int] = {}
        self._rows: dict[str, list[tuple[float, float]]] = {
            SKELETONS.stream: [],
            POSE.stream: [],
        }

    @contextmanager
    def listening(self, session: Session, site: Site) -> Iterator[None]:
        """Listen until the block ends."""
        handles = [self._subscribe(session, site, topic) for topic in (SKELETONS, POSE)]
        handles.append(subscribe(session, HEALTH.pattern(site), HEALTH.delivery, self._note_health))
        try:
            yield
        finally:
            for handle in handles:
                end_subscription(handle)

    def of(self, topic: AnyTopic) -> Arrivals:
        """All that came of a topic so far."""
        with self._lock:
            rows = np.array(self._rows[topic.stream]).reshape(-1, 2)
        stamps, came = rows.T
        return Arrivals(self._clock.true_times(stamps, came), came, stamps)

    def malformed(self) -> int:
        """How many messages the rig's processes have counted as malformed, in all they said."""
        with self._lock:
            return sum(self._malformed.values())

    def _note_health(self, sample: Received) -> None:
        try:
            health = HEALTH.decode(sample.payload, sample.encoding)
        except (MessageError, UnknownVersionError):
            return  # one of ours: a fault sends such
        if sample.key.endswith(f"/{health.instance}"):  # else it is forged
            count = sum(topic.malformed for topic in health.topics.values())
            with self._lock:
                self._malformed[health.instance] = count

    def _subscribe(self, session: Session, site: Site, topic: AnyTopic) -> Subscription:
        rows = self._rows[topic.stream]

        def note(sample: Received) -> None:
            try:
                message = topic.decode(sample.payload, sample.encoding)
            except (MessageError, UnknownVersionError):
                return  # one of ours: a fault sends such
            with self._lock:
                rows.append((message.time_ns / 1e9, sample.received_ns / 1e9))

        return subscribe(session, topic.pattern(site), topic.delivery, note)


@dataclass(frozen=True)
class Recovery:
    """How a stream came through a fault, in seconds.

    ``silent_s`` is the longest time in which nothing came, from the fault's begin on. Of the time
    after the cause's end, ``back_s`` is when something new came, and ``normal_s`` from when on all
    were as old as usual; None where that was not seen.
    """

    silent_s: float
    back_s: float | None
    normal_s: float | None


def recovery_of(
    arrivals: Arrivals,
    begin: float,
    end: float,
    until: float,
    parameters: ChaosParameters = DEFAULT_CHAOS,
) -> Recovery:
    """Say how a stream came through a fault whose cause lasted from ``begin`` to ``end`` and that
    was watched ``until`` then, all in seconds since the epoch."""
    before = arrivals.between(begin - parameters.well_s, begin)
    during = arrivals.between(begin, until)
    edges = np.concatenate(([begin], during.came, [until]))
    new = during.came[(during.came >= end) & (during.captured >= end)]
    back_s = float(new[0] - end) if len(new) > 0 else None
    normal_s = None
    if len(before.came) > 0 and back_s is not None:
        usual = 1e3 * float(np.median(before.ages))
        limit_ms = parameters.usual_age_ratio * usual + parameters.usual_age_more_ms
        normal_s = _normal_after(during, end, until, limit_ms / 1e3, parameters.window_s)
        normal_s = None if normal_s is None else max(normal_s, back_s)
    return Recovery(float(np.diff(edges).max()), back_s, normal_s)


def _normal_after(
    arrivals: Arrivals, end: float, until: float, limit: float, window_s: float
) -> float | None:
    """Seconds after ``end`` at which those windows begin that are all normal up to the last."""
    normal = None
    starts = np.arange(end, until - window_s + 1e-9, window_s)
    for start in starts[::-1]:
        ages = arrivals.between(start, start + window_s).ages
        if len(ages) == 0 or float(np.median(ages)) > limit:
            break
        normal = float(start - end)
    return normal
