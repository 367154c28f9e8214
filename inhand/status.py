"""``inhand status``: list the live instances of a site and how they do."""

import argparse
import time
from pathlib import Path
from typing import Any

import msgspec
from inhand_runtime.daemon import HEALTH_PERIOD_S
from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.messages import Health
from inhand_schemas.topics import HEALTH
from rich.console import Console
from rich.table import Table

from inhand.looking import (
    Look,
    add_looking_arguments,
    nothing_heard,
    open_look,
    output,
)
from inhand.results import write_json

SECONDS = 5.0
SETTLED_S = 1.5 * HEALTH_PERIOD_S

Instance = tuple[str, str]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    add_looking_arguments(parser, SECONDS)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the list there")


def run(arguments: argparse.Namespace) -> int:
    """Print who lives and what they last said; raises InhandError when nobody answers."""
    roll = Roll()
    with open_look(arguments.config) as look:
        look.follow_tokens(roll.change)
        look.follow(HEALTH)
        _listen(look, roll, arguments.seconds)
    instances = roll.living()
    if not instances:
        raise nothing_heard(look.site, arguments.seconds)
    output().print(_table(instances))
    if arguments.json is not None:
        rows = [_row(instance, health) for instance, health in instances.items()]
        write_json(arguments.json, {"instances": rows})
    return 0


class Roll:
    """Who lives, and each one's last health."""

    def __init__(self) -> None:
        self._living: set[Instance] = set()
        self._healths: dict[Instance, Health] = {}
        self._changed = time.monotonic()

    def change(self, service: str, instance: str, lives: bool) -> None:
        """Take note of a liveliness token, from any thread."""
        self._changed = time.monotonic()
        (self._living.add if lives else self._living.discard)((service, instance))

    def hear(self, health: Health) -> None:
        """Take note of a health message."""
        self._healths[(health.service, health.instance)] = health

    def living(self) -> dict[Instance, Health | None]:
        """The live instances, with None for one that said nothing yet."""
        return {instance: self._healths.get(instance) for instance in sorted(self._living)}

    def settled(self) -> bool:
        """Whether everybody who lives spoke, and nobody came or went of late."""
        quiet = time.monotonic() - self._changed > SETTLED_S
        return quiet and bool(self._living) and None not in self.living().values()


def _listen(look: Look, roll: Roll, seconds: float | None) -> None:
    for sample in look.samples(seconds):
        if sample is not None:
            try:
                roll.hear(HEALTH.decode(sample.payload, sample.encoding))
            except (MessageError, KeyFormatError) as error:
                Console(stderr=True).print(f"{sample.key}: {error}", soft_wrap=True)
        if roll.settled():
            return


def _row(instance: Instance, health: Health | None) -> dict[str, Any]:
    service, name = instance
    told = None if health is None else msgspec.to_builtins(health)
    return {"service": service, "instance": name, "health": told}


def _table(instances: dict[Instance, Health | None]) -> Table:
    table = Table(
        "service", "instance", "state", "up s", "MB", "latency ms", "in/s", "dropped", "last error"
    )
    for (service, name), health in instances.items():
        if health is None:
            table.add_row(service, name, "silent")
            continue
        latency = health.latency_ms
        topics = health.topics.values()
        table.add_row(
            service,
            name,
            health.state,
            f"{health.uptime_s:.0f}",
            f"{health.resident_bytes / 1e6:.0f}",
            "" if latency is None else f"{latency.p50:.1f} / {latency.p99:.1f}",
            f"{sum(topic.rate_hz for topic in topics):.1f}",
            str(sum(topic.dropped + topic.malformed for topic in topics)),
            health.last_error or "",
        )
    return table
