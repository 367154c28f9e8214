"""What an instance counts and knows about itself, and publishes once a second."""

import logging
import re
import threading
import time
from collections import Counter, deque
from collections.abc import Callable
from dataclasses import dataclass
from fnmatch import fnmatchcase

import psutil
from inhand_schemas.fields import ServiceState
from inhand_schemas.messages import Health, Latency, RecordingState, TopicHealth

from inhand_runtime.wording import printable

log = logging.getLogger(__name__)

WINDOW_S = 10.0
"""Seconds over which latencies are reported: what is older says nothing of how things go."""
LATENCY_SAMPLES = 1000
LONGEST_LATENCY_MS = 60_000.0
"""Milliseconds since capture from which on a capture's time is another clock's, or a replay's."""
MOST_KEYS = 1024
OTHER_KEYS = "(other keys)"
MOST_TROUBLES = 64
LONGEST_TEXT = 4096
PASSING_LASTS_S = 5.0
"""Seconds for which a malformed message, or memory that could not be read, is a trouble of now."""
FARTHEST_GAP = 1 << 20
"""Number of missing messages from which on a gap is another publisher's numbering."""
LOOP_LATE_S = 3.0
"""Seconds after which a main loop that did not come round is called late."""
_NUMBERS = re.compile(r"\d+")


@dataclass(frozen=True)
class _Trouble:
    text: str
    ends_at: float


class HealthBoard:
    """Thread-safe counters of one instance, its troubles, and when its main loop came round."""

    def __init__(
        self,
        service: str,
        instance: str,
        now: Callable[[], float] = time.monotonic,
        on_round: Callable[[], None] = lambda: None,
    ) -> None:
        """``on_round`` is called in the main loop, each time that it comes round."""
        self._on_round = on_round
        self.state: ServiceState = "starting"
        self.effort: float | None = None
        self.shutter_closed: bool | None = None
        self.recording: RecordingState | None = None
        self.paused: bool | None = None
        self.service = service
        self._instance = instance
        self._now = now
        self._lock = threading.Lock()
        self._started = now()
        self._process = psutil.Process()
        self._resident_bytes = 0
        self._published: Counter[str] = Counter()
        self._received: Counter[str] = Counter()
        self._dropped: Counter[str] = Counter()
        self._refused: Counter[str] = Counter()
        self._malformed: Counter[str] = Counter()
        self._lost: Counter[str] = Counter()
        self._unwritten: Counter[str] = Counter()
        self._overflowed: Counter[str] = Counter()
        self._latest_ms: dict[str, float] = {}
        self._sequences: dict[str, int] = {}
        self._keys: set[str] = set()
        self._kinds_logged: set[tuple[str, str]] = set()
        self._latencies_ms: deque[tuple[float, float]] = deque(maxlen=LATENCY_SAMPLES)
        self._troubles: dict[str, _Trouble] = {}
        self._last_error: str | None = None
        self._last_totals: Counter[str] = Counter()
        self._last_report = self._started
        self._came_round = self._started
        self._sequence = 0

    def published(self, key: str) -> None:
        """Count a message sent."""
        self._count(self._published, key)

    def received(self, key: str, sequence: int | None = None) -> None:
        """Count a message taken out of the inbox, and those that its number shows as missing.

        What the inbox had no room for came, and is not missing. A number that goes back, or far
        ahead, means a publisher that began anew, and no loss.
        """
        key = self._count(self._received, key)
        if sequence is None or key == OTHER_KEYS:
            return
        with self._lock:
            missing = sequence - self._sequences.get(key, sequence) - 1
            missing -= self._overflowed.pop(key, 0)
            self._sequences[key] = sequence
            if 0 < missing < FARTHEST_GAP:
                self._lost[key] += missing

    def begin_anew(self, pattern: str) -> None:
        """Forget the last numbers of the keys of a pattern: what comes next follows nothing."""
        with self._lock:
            for key in [key for key in self._sequences if fnmatchcase(key, pattern)]:
                del self._sequences[key]
                self._overflowed.pop(key, None)

    def overflowed(self, key: str) -> None:
        """Count a message that the inbox had no room for."""
        key = self._count(self._dropped, key)
        with self._lock:
            self._overflowed[key] += 1

    def dropped(self, key: str, count: int = 1) -> None:
        """Count messages that were skipped as too old, or for another reason than a full inbox."""
        self._count(self._dropped, key, count)

    def refused(self, key: str) -> None:
        """Count a message that the instance does not take, however much room there is."""
        self._count(self._refused, key)

    def unwritten(self, key: str, count: int) -> None:
        """Count those among the dropped that a disk could not take."""
        with self._lock:
            self._unwritten[key] += count

    def unwritten_counts(self) -> dict[str, int]:
        """How many messages of each key a disk could not take so far."""
        with self._lock:
            return dict(self._unwritten)

    def lost_counts(self) -> dict[str, int]:
        """How many messages of each key never came so far."""
        with self._lock:
            return dict(self._lost)

    def drops(self) -> dict[str, int]:
        """How many messages of each key the inbox had no room for so far."""
        with self._lock:
            return dict(self._dropped)

    def malformed(self, key: str, error: Exception) -> None:
        """Count a message that cannot be read; each kind is logged once, and is a trouble while
        such messages come."""
        counted = self._count(self._malformed, key)
        kind = (counted, type(error).__name__)
        text = printable(f"{key}: dropped a message: {error}"[:LONGEST_TEXT])[:LONGEST_TEXT]
        with self._lock:
            first = kind not in self._kinds_logged
            self._kinds_logged.add(kind)
            self._last_error = text
            self._set_trouble(f"malformed {counted}", text, self._now() + PASSING_LASTS_S)
        if first:
            log.warning("%s (further ones are only counted)", text)

    def arrived(self, key: str, late_ns: int) -> None:
        """Note how long after its capture a message arrived; a clock that jumped says nothing."""
        late_ms = late_ns / 1e6
        if 0 <= late_ms < LONGEST_LATENCY_MS:
            with self._lock:
                key = key if key in self._keys else OTHER_KEYS
                self._latest_ms[key] = max(late_ms, self._latest_ms.get(key, 0.0))

    def latency(self, captured_ns: int) -> None:
        """Note the time from capture to now; a clock that jumped says nothing."""
        latency_ms = (time.time_ns() - captured_ns) / 1e6
        if 0 <= latency_ms < LONGEST_LATENCY_MS:
            with self._lock:
                self._latencies_ms.append((self._now(), latency_ms))

    def came_round(self) -> None:
        """Note that the main loop lives: a service says so each time it comes round."""
        self._came_round = self._now()
        self._on_round()

    def error(self, text: str) -> None:
        """Remember the last thing that went wrong, and log it."""
        with self._lock:
            self._last_error = text[:LONGEST_TEXT]
        log.error("%s", text)

    def trouble(self, name: str, text: str, *, lasts_s: float = float("inf")) -> None:
        """Say what is wrong from now on, until ``well(name)`` or for some seconds.

        While anything is wrong a running instance is degraded. A text is logged when more than its
        numbers is new.
        """
        text = text[:LONGEST_TEXT]
        with self._lock:
            before = self._troubles.get(name)
            self._set_trouble(name, text, self._now() + lasts_s)
            self._last_error = text
        if before is None or _NUMBERS.sub("", before.text) != _NUMBERS.sub("", text):
            log.error("%s", text)

    def well(self, name: str) -> None:
        """Take back a trouble; nothing happens where there is none."""
        with self._lock:
            ended = self._troubles.pop(name, None)
        if ended is not None:
            log.info("no longer: %s", ended.text)

    def _set_trouble(self, name: str, text: str, ends_at: float) -> None:
        if name in self._troubles or len(self._troubles) < MOST_TROUBLES:
            self._troubles[name] = _Trouble(text, ends_at)

    def _count(self, counter: Counter[str], key: str, count: int = 1) -> str:
        """Count under the key, or under one for all others where a sender invents ever new ones."""
        with self._lock:
            if key not in self._keys and len(self._keys) >= MOST_KEYS:
                key = OTHER_KEYS
            self._keys.add(key)
            counter[key] += count
        return key

    def report(self) -> Health:
        """The message for now; rates are over the time since the last report."""
        now = self._now()
        with self._lock:
            totals = self._published + self._received
            elapsed = max(now - self._last_report, 1e-3)
            topics = {
                key: TopicHealth(
                    published=self._published[key],
                    received=self._received[key],
                    dropped=self._dropped[key],
                    malformed=self._malformed[key],
                    lost=self._lost[key],
                    rate_hz=(totals[key] - self._last_totals[key]) / elapsed,
                    late_ms=self._latest_ms.get(key),
                    refused=self._refused[key],
                    unwritten=self._unwritten[key],
                )
                for key in sorted(self._keys)
            }
            self._latest_ms = {}
            self._last_totals, self._last_report = totals, now
            self._sequence += 1
            resident_bytes = self._read_memory(now)
            troubles = self._current_troubles(now)
            return Health(
                sequence=self._sequence - 1,
                time_ns=time.time_ns(),
                service=self.service,
                instance=self._instance,
                state="degraded" if troubles and self.state == "running" else self.state,
                uptime_s=now - self._started,
                resident_bytes=resident_bytes,
                topics=topics,
                latency_ms=self._current_latency(now),
                effort=self.effort,
                shutter_closed=self.shutter_closed,
                recording=self.recording,
                paused=self.paused,
                last_error=self._last_error,
                troubles=troubles,
                loop_age_s=max(now - self._came_round, 0.0),
            )

    def _read_memory(self, now: float) -> int:
        """Return this process's memory, or what it was last where too many files are open."""
        try:
            self._resident_bytes = self._process.memory_info().rss
        except OSError as error:
            text = f"cannot read how much memory it takes: {error.strerror}"
            self._set_trouble("memory", text, now + PASSING_LASTS_S)
        return self._resident_bytes

    def _current_troubles(self, now: float) -> tuple[str, ...]:
        for name in [name for name, trouble in self._troubles.items() if trouble.ends_at <= now]:
            del self._troubles[name]
        troubles = [trouble.text for trouble in self._troubles.values()]
        late = now - self._came_round
        if self.state == "running" and late > LOOP_LATE_S:
            troubles.append(f"its main loop has not come round for {late:.0f} s: it may hang")
        return tuple(troubles[:MOST_TROUBLES])

    def _current_latency(self, now: float) -> Latency | None:
        latencies = sorted(ms for at, ms in self._latencies_ms if now - at <= WINDOW_S)
        if not latencies:
            return None
        return Latency(p50=_quantile(latencies, 0.50), p99=_quantile(latencies, 0.99))


def _quantile(ordered: list[float], share: float) -> float:
    """Return the value below which a share of ordered values lies, between two neighbours."""
    place = share * (len(ordered) - 1)
    below = int(place)
    above = min(below + 1, len(ordered) - 1)
    return ordered[below] + (place - below) * (ordered[above] - ordered[below])
