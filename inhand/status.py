"""``inhand status``: list the live instances of a site, and all that is wrong there.

Exit code 1 when anything is wrong: somebody whom the settings name is missing, hangs, has trouble,
or two publish the same.
"""

import argparse
from pathlib import Path
from typing import Any

import msgspec
from inhand_runtime.exit_codes import DONE, FAILED
from inhand_runtime.settings import SERVICES, load_rig_file
from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.messages import Health
from inhand_schemas.topics import HEALTH
from rich.console import Console
from rich.table import Table

from inhand.instances import Heard, Instance, Roll, short_key
from inhand.looking import (
    Look,
    add_looking_arguments,
    nothing_heard,
    open_look,
    output,
)
from inhand.results import listing, write_json

SECONDS = 5.0
MOST_KEYS = 10
"""Number of keys of an instance, at the most, whose unused messages have a line each."""
LATE_MS = 100.0
"""Milliseconds after its capture from which on a message is said to come late."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    add_looking_arguments(parser, SECONDS)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the list there")


def run(arguments: argparse.Namespace) -> int:
    """Print who lives, what they last said and what is wrong; InhandError when nobody answers."""
    expected = expected_instances(arguments.config)
    roll = Roll()
    with open_look(arguments.config) as look:
        look.follow_tokens(roll.change)
        look.follow(HEALTH)
        _listen(look, roll, expected, arguments.seconds)
    living, problems = roll.living(), roll.problems(expected)
    if not living and not expected:
        raise nothing_heard(look.site, arguments.seconds)
    if living:
        output().print(_table(living))
    for line in (*left_unused(living), *late_lines(living)):
        print(line)
    for line in problems:
        print(f"WRONG: {line}")
    if arguments.json is not None:
        rows = [_row(instance, heard) for instance, heard in living.items()]
        write_json(arguments.json, {"instances": rows, "problems": problems})
    return FAILED if problems else DONE


def expected_instances(config: Path | None) -> tuple[Instance, ...]:
    """Whom the settings file names; raises SettingsError."""
    rig_file = load_rig_file(config)
    return tuple((service, name) for service in SERVICES for name in getattr(rig_file, service))


def _listen(look: Look, roll: Roll, expected: tuple[Instance, ...], seconds: float | None) -> None:
    for sample in look.samples(seconds):
        if sample is not None:
            try:
                roll.hear(HEALTH.decode(sample.payload, sample.encoding))
            except (MessageError, KeyFormatError) as error:
                Console(stderr=True).print(f"{sample.key}: {error}", soft_wrap=True)
        if roll.settled(expected):
            return


def _row(instance: Instance, heard: Heard | None) -> dict[str, Any]:
    service, name = instance
    health = None if heard is None else msgspec.to_builtins(heard.health)
    return {"service": service, "instance": name, "health": health}


def _table(living: dict[Instance, Heard | None]) -> Table:
    table = listing(("instance", "state"), ("up s", "MB", "latency\nms", "msg/s", "unused"))
    for instance, heard in living.items():
        if heard is None:
            table.add_row(" ".join(instance), "silent")
            continue
        health = heard.health
        latency = health.latency_ms
        table.add_row(
            " ".join(instance),
            health.state,
            f"{health.uptime_s:.0f}",
            f"{health.resident_bytes / 1e6:.0f}",
            "" if latency is None else f"{latency.p50:.1f} / {latency.p99:.1f}",
            f"{sum(topic.rate_hz for topic in health.topics.values()):.1f}",
            str(sum(_unused(health).values())),
        )
    return table


def _unused(health: Health) -> dict[str, int]:
    """How many messages of each key came and were not used, or never came."""
    return {
        key: topic.dropped + topic.malformed + topic.lost
        for key, topic in health.topics.items()
        if topic.dropped or topic.malformed or topic.lost
    }


def late_lines(living: dict[Instance, Heard | None]) -> list[str]:
    """One line for each key that came late to an instance, and for each that cannot keep up."""
    lines = []
    for instance, heard in living.items():
        if heard is None:
            continue
        who, health = " ".join(instance), heard.health
        for key, topic in health.topics.items():
            if topic.late_ms is not None and topic.late_ms >= LATE_MS:
                lines.append(f"{who}, {short_key(key)}: up to {topic.late_ms:.0f} ms after capture")
        if health.effort is not None and health.effort < 1.0:
            lines.append(
                f"{who}: does {100.0 * health.effort:.0f} % of its usual work in a frame, to keep "
                "up with its camera"
            )
    return lines


def left_unused(living: dict[Instance, Heard | None]) -> list[str]:
    """One line for each key that an instance did not use every message of, and why; of many keys
    those with the most."""
    lines = []
    for instance, heard in living.items():
        if heard is None:
            continue
        who, unused = " ".join(instance), _unused(heard.health)
        most = sorted(unused, key=unused.__getitem__, reverse=True)[:MOST_KEYS]
        for key in most:
            topic = heard.health.topics[key]
            reasons = [
                f"{count} {reason}"
                for count, reason in (
                    (topic.dropped, "came too late or too fast"),
                    (topic.malformed, "could not be read"),
                    (topic.lost, "never came"),
                )
                if count
            ]
            lines.append(f"{who}, {short_key(key)}: {', '.join(reasons)}")
        if len(most) < len(unused):
            left = sum(unused.values()) - sum(unused[key] for key in most)
            lines.append(
                f"{who}, {len(unused) - len(most)} more keys: {left} messages were not used"
            )
    return lines
