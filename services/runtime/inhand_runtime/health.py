"""What an instance counts about itself, and tells once a second."""

import logging
import threading
import time
from collections import Counter, deque

import numpy as np
import psutil
from inhand_schemas.messages import Health, Latency, ServiceState, TopicHealth

log = logging.getLogger(__name__)

LATENCY_SAMPLES = 300
MOST_KEYS = 1024
OTHER_KEYS = "(other keys)"


class HealthBoard:
    """Thread-safe counters of one instance."""

    def __init__(self, service: str, instance: str) -> None:
        self.state: ServiceState = "starting"
        self._service = service
        self._instance = instance
        self._lock = threading.Lock()
        self._started = time.monotonic()
        self._process = psutil.Process()
        self._published: Counter[str] = Counter()
        self._received: Counter[str] = Counter()
        self._dropped: Counter[str] = Counter()
        self._malformed: Counter[str] = Counter()
        self._keys: set[str] = set()
        self._kinds_logged: set[tuple[str, str]] = set()
        self._latencies_ms: deque[float] = deque(maxlen=LATENCY_SAMPLES)
        self._last_error: str | None = None
        self._last_totals: Counter[str] = Counter()
        self._last_report = self._started
        self._sequence = 0

    def published(self, key: str) -> None:
        """Count a message sent."""
        self._count(self._published, key)

    def received(self, key: str) -> None:
        """Count a message taken out of the inbox."""
        self._count(self._received, key)

    def dropped(self, key: str) -> None:
        """Count a message that the inbox had no room for."""
        self._count(self._dropped, key)

    def drops(self) -> dict[str, int]:
        """How many messages of each key the inbox had no room for so far."""
        with self._lock:
            return dict(self._dropped)

    def malformed(self, key: str, error: Exception) -> None:
        """Count a message that cannot be read; each kind is logged once."""
        kind = (self._count(self._malformed, key), type(error).__name__)
        with self._lock:
            first = kind not in self._kinds_logged
            self._kinds_logged.add(kind)
        if first:
            log.warning("%s: dropped a message: %s (further ones are only counted)", key, error)

    def latency(self, captured_ns: int) -> None:
        """Note the time from capture to now; a clock that jumped says nothing."""
        latency_ms = (time.time_ns() - captured_ns) / 1e6
        if 0 <= latency_ms < 60_000:
            with self._lock:
                self._latencies_ms.append(latency_ms)

    def error(self, text: str) -> None:
        """Remember the last thing that went wrong, and log it."""
        with self._lock:
            self._last_error = text[:4096]
        log.error("%s", text)

    def _count(self, counter: Counter[str], key: str) -> str:
        """Count under the key, or under one for all others where a sender invents ever new ones."""
        with self._lock:
            if key not in self._keys and len(self._keys) >= MOST_KEYS:
                key = OTHER_KEYS
            self._keys.add(key)
            counter[key] += 1
        return key

    def report(self) -> Health:
        """The message for now; rates are over the time since the last report."""
        now = time.monotonic()
        with self._lock:
            totals = self._published + self._received
            elapsed = max(now - self._last_report, 1e-3)
            topics = {
                key: TopicHealth(
                    published=self._published[key],
                    received=self._received[key],
                    dropped=self._dropped[key],
                    malformed=self._malformed[key],
                    rate_hz=(totals[key] - self._last_totals[key]) / elapsed,
                )
                for key in sorted(self._keys)
            }
            latency = None
            if self._latencies_ms:
                p50, p99 = np.percentile(self._latencies_ms, (50, 99)).tolist()
                latency = Latency(p50=p50, p99=p99)
            self._last_totals, self._last_report = totals, now
            self._sequence += 1
            return Health(
                sequence=self._sequence - 1,
                time_ns=time.time_ns(),
                service=self._service,
                instance=self._instance,
                state=self.state,
                uptime_s=now - self._started,
                resident_bytes=self._process.memory_info().rss,
                topics=topics,
                latency_ms=latency,
                last_error=self._last_error,
            )
