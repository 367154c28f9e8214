"""Numbers of the health of a rig's instances, as Prometheus reads them.

Names follow Prometheus: base units, and ``_total`` for what only grows.
"""

import time
from collections.abc import Callable, Iterable, Iterator
from typing import get_args

from inhand_runtime.roll import Heard, Instance, Roll
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.fields import ServiceState
from inhand_schemas.keys import Site, parse_key
from inhand_schemas.messages import Health, TopicHealth
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

from inhand.instances import problems

INSTANCE = ("service", "daemon")
"""Labels of an instance; Prometheus itself has one called ``instance``, for what it reads."""
KEY = (*INSTANCE, "stream", "name")

Row = tuple[tuple[str, ...], float]

GAUGES: dict[str, tuple[str, Callable[[Health], float | None]]] = {
    "inhand_instance_uptime_seconds": ("Seconds since it started", lambda one: one.uptime_s),
    "inhand_instance_resident_bytes": ("Its memory", lambda one: one.resident_bytes),
    "inhand_instance_loop_age_seconds": (
        "Seconds since its main loop last came round",
        lambda one: one.loop_age_s,
    ),
    "inhand_instance_troubles": ("Number of its troubles", lambda one: len(one.troubles)),
    "inhand_instance_effort_ratio": (
        "Share of its usual work that a tracker does in a frame",
        lambda one: one.effort,
    ),
    "inhand_instance_shutter_closed": (
        "1 while a camera's shutter is closed",
        lambda one: one.shutter_closed,
    ),
}
COUNTERS: dict[str, tuple[str, Callable[[TopicHealth], float]]] = {
    "inhand_messages_published": ("Messages sent", lambda one: one.published),
    "inhand_messages_received": ("Messages that came", lambda one: one.received),
    "inhand_messages_dropped": ("Messages that came too late or fast", lambda one: one.dropped),
    "inhand_messages_unwritten": (
        "Those of the dropped that a recorder's disk could not take",
        lambda one: one.unwritten,
    ),
    "inhand_messages_refused": ("Messages on more keys than are taken", lambda one: one.refused),
    "inhand_messages_malformed": ("Messages that cannot be read", lambda one: one.malformed),
    "inhand_messages_lost": ("Messages that never came", lambda one: one.lost),
}


class HealthMetrics(Collector):
    """What a roll knows at the moment at which it is asked, from any thread."""

    def __init__(
        self, roll: Roll, site: Site, expected: Iterable[Instance], can_hear: Callable[[], bool]
    ) -> None:
        """``site`` is the rig's, ``expected`` are those whom the settings name, and who are down
        when they do not live; ``can_hear`` says whether anything can be heard at all."""
        self._roll = roll
        self._site = site
        self._expected = tuple(expected)
        self._can_hear = can_hear

    def collect(self) -> Iterator[Metric]:
        """Return all metrics, as Prometheus's library asks for them."""
        living, silent = self._roll.living(), set(self._roll.silent())
        heard = {one: said for one, said in living.items() if said is not None}
        up = {one: one in heard and one not in silent for one in (*living, *self._expected)}
        wrong = len(problems(self._roll, self._expected))
        yield _gauge(
            "inhand_connected",
            "1 while a hub, where one is needed, is connected",
            (),
            [((), self._can_hear())],
        )
        yield _gauge("inhand_problems", "Lines that inhand status calls WRONG", (), [((), wrong)])
        yield _gauge(
            "inhand_instance_up",
            "1 while it lives and speaks, 0 while it is missing or hangs",
            INSTANCE,
            sorted(up.items()),
        )
        yield from _of_instances(heard)
        yield from _of_keys(heard, self._site)


def _of_instances(heard: dict[Instance, Heard]) -> Iterator[Metric]:
    for name, (text, value_of) in GAUGES.items():
        values = [(one, value_of(said.health)) for one, said in heard.items()]
        rows = [(one, value) for one, value in values if value is not None]
        yield _gauge(name, text, INSTANCE, rows)
    yield _gauge(
        "inhand_instance_health_age_seconds",
        "Seconds since it last spoke",
        INSTANCE,
        [(one, time.monotonic() - said.at) for one, said in heard.items()],
    )
    yield _gauge(
        "inhand_instance_state",
        "1 for the state in which it is",
        (*INSTANCE, "state"),
        [
            ((*one, state), said.health.state == state)
            for one, said in heard.items()
            for state in get_args(ServiceState)
        ],
    )
    yield _gauge(
        "inhand_instance_latency_seconds",
        "Age of what it has just published or handled, since capture",
        (*INSTANCE, "quantile"),
        [
            ((*one, quantile), value / 1e3)
            for one, said in heard.items()
            if (latency := said.health.latency_ms) is not None
            for quantile, value in (("0.5", latency.p50), ("0.99", latency.p99))
        ],
    )


def _of_keys(heard: dict[Instance, Heard], site: Site) -> Iterator[Metric]:
    keys = [
        ((*one, *_stream_and_name(key, site)), topic)
        for one, said in heard.items()
        for key, topic in said.health.topics.items()
    ]
    for name, (text, value_of) in COUNTERS.items():
        family = CounterMetricFamily(name, text, labels=KEY)
        for labels, topic in keys:
            family.add_metric(labels, value_of(topic))
        yield family
    yield _gauge(
        "inhand_messages_rate_hertz",
        "Messages a second, sent and come",
        KEY,
        [(labels, topic.rate_hz) for labels, topic in keys],
    )
    yield _gauge(
        "inhand_messages_late_seconds",
        "Longest time from capture to arrival in the last second",
        KEY,
        [(labels, topic.late_ms / 1e3) for labels, topic in keys if topic.late_ms is not None],
    )


def _gauge(name: str, text: str, labels: tuple[str, ...], rows: Iterable[Row]) -> Metric:
    family = GaugeMetricFamily(name, text, labels=labels)
    for values, value in rows:
        family.add_metric(values, float(value))
    return family


def _stream_and_name(key: str, site: Site) -> tuple[str, str]:
    """The stream and name of a key of the rig; any other, as where a hub shows itself in another
    rig, is the name of no stream."""
    try:
        parsed = parse_key(key)
    except KeyFormatError:
        return "", key
    return (parsed.stream, parsed.name) if parsed.site == site else ("", key)
