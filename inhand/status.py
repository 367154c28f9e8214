"""``inhand status``: list the live instances of a site, and all that is wrong there.

Exit code 1 when anything is wrong: somebody whom the settings name is missing, hangs, has trouble,
or two publish the same.
"""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec
from inhand_runtime.exit_codes import DONE, FAILED
from inhand_runtime.settings import SERVICES, load_rig_file
from inhand_runtime.wording import counted
from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.messages import Health, TopicHealth
from inhand_schemas.topics import HEALTH
from rich.console import Console
from rich.table import Table

from inhand.instances import Heard, Roll, short_key
from inhand.looking import (
    Look,
    add_looking_arguments,
    nothing_heard,
    open_look,
    output,
)
from inhand.results import listing, write_json
from inhand.stopped import Instance, stopped_services

SECONDS = 5.0
MOST_KEYS = 5
"""Number of keys of an instance, at the most, that have a line each of one kind."""
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
    living, stopped = roll.living(), stopped_services(load_rig_file(arguments.config).zenoh)
    problems = roll.problems(expected, stopped)
    if not living and not expected and not problems:
        raise nothing_heard(look.site, arguments.seconds)
    if living:
        output().print(_table(living))
    for line in (*closed_shutters(living), *left_unused(living), *late_lines(living)):
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
            "shut" if health.shutter_closed else health.state,
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
        key: topic.dropped + topic.refused + topic.malformed + topic.lost
        for key, topic in health.topics.items()
        if topic.dropped or topic.refused or topic.malformed or topic.lost
    }


def closed_shutters(living: dict[Instance, Heard | None]) -> list[str]:
    """One line for each camera whose shutter is closed."""
    return [
        f"{' '.join(instance)}: the shutter is closed: no pictures and no skeletons until "
        f"`inhand shutter open --camera {instance[1]}`"
        for instance, heard in living.items()
        if heard is not None and heard.health.shutter_closed
    ]


def late_lines(living: dict[Instance, Heard | None]) -> list[str]:
    """Return a line for each key that came late to an instance, and for each that cannot keep up;
    of many keys a line for the latest, and one for all others."""
    lines = []
    for instance, heard in living.items():
        if heard is None:
            continue
        who, health = " ".join(instance), heard.health
        late_ms = {
            key: topic.late_ms
            for key, topic in health.topics.items()
            if topic.late_ms is not None and topic.late_ms >= LATE_MS
        }
        latest, others = _first(late_ms)
        lines += [
            f"{who}, {short_key(key)}: up to {late_ms[key]:.0f} ms after capture" for key in latest
        ]
        if others:
            longest_ms = max(late_ms[key] for key in others)
            lines.append(
                f"{who}, and {counted(len(others), 'more key')}: up to {longest_ms:.0f} ms after "
                "capture"
            )
        if health.effort is not None and health.effort < 1.0:
            lines.append(
                f"{who}: does {100.0 * health.effort:.0f} % of its usual work in a frame, to keep "
                "up with its camera"
            )
    return lines


def left_unused(living: dict[Instance, Heard | None]) -> list[str]:
    """Return a line for each key that an instance did not use every message of, and why; of many
    keys a line for those with the most, and one for all others."""
    lines = []
    for instance, heard in living.items():
        if heard is None:
            continue
        who, topics, unused = " ".join(instance), heard.health.topics, _unused(heard.health)
        most, others = _first(unused)
        lines += [f"{who}, {short_key(key)}: {_reasons([topics[key]])}" for key in most]
        if others:
            reasons = _reasons([topics[key] for key in others])
            lines.append(f"{who}, and {counted(len(others), 'more key')}: {reasons}")
    return lines


def _reasons(topics: Sequence[TopicHealth]) -> str:
    """Why messages of these keys were not used, and how many for each reason."""
    counts = (
        (sum(topic.dropped for topic in topics), "came too late or too fast"),
        (sum(topic.refused for topic in topics), "came on more keys than are recorded"),
        (sum(topic.malformed for topic in topics), "could not be read"),
        (sum(topic.lost for topic in topics), "never came"),
    )
    return ", ".join(f"{count} {reason}" for count, reason in counts if count)


def _first(amounts: Mapping[str, float]) -> tuple[list[str], list[str]]:
    """The keys with the greatest amounts, and all others."""
    ordered = sorted(amounts, key=amounts.__getitem__, reverse=True)
    return ordered[:MOST_KEYS], ordered[MOST_KEYS:]
