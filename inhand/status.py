"""``inhand status``: list the live instances of a site, and all that is wrong there.

Exit code 1 when anything is wrong: somebody whom the settings name is missing, hangs, has trouble,
or two publish the same.
"""

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
from inhand_runtime.exit_codes import DONE, FAILED
from inhand_runtime.health_lines import (
    deleted_recordings,
    late_lines,
    left_unused,
    shown_state,
    stilled_instances,
    unused_counts,
)
from inhand_runtime.roll import Heard, Instance, Roll
from inhand_runtime.settings import SERVICES, load_rig_file
from inhand_runtime.wording import printable
from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.topics import HEALTH
from rich.table import Table

from inhand.instances import problems
from inhand.looking import (
    Look,
    add_looking_arguments,
    nothing_heard,
    open_look,
    output,
)
from inhand.results import listing, write_json
from inhand.stopped import stopped_services

SECONDS = 5.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    add_looking_arguments(parser, SECONDS)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the list there")


def run(arguments: argparse.Namespace) -> int:
    """Print who lives, what they last said and what is wrong; InhandError when nobody answers."""
    state = look_at_site(arguments.config, arguments.seconds)
    if state.living:
        output().print(_table(state.living))
    living = state.living
    for line in (
        *stilled_instances(living),
        *deleted_recordings(living),
        *left_unused(living),
        *late_lines(living),
    ):
        print(line)
    for line in state.problems:
        print(f"WRONG: {line}")
    if arguments.json is not None:
        write_json(arguments.json, state.for_machines())
    return FAILED if state.problems else DONE


@dataclass(frozen=True)
class SiteState:
    """Who lives and what each last said, and all that is wrong there, a line each."""

    living: dict[Instance, Heard | None]
    problems: list[str]

    def for_machines(self) -> dict[str, Any]:
        """Return it as ``--json`` writes it."""
        rows = [_row(instance, heard) for instance, heard in self.living.items()]
        return {"instances": rows, "problems": self.problems}


def look_at_site(config: Path | None, seconds: float = SECONDS) -> SiteState:
    """Listen until all have spoken, or for ``seconds``; raises InhandError when nobody answers,
    and SettingsError."""
    expected = expected_instances(config)
    roll = Roll()
    with open_look(config) as look:
        look.follow_tokens(roll.change)
        look.follow(HEALTH)
        _listen(look, roll, expected, seconds)
    living, stopped = roll.living(), stopped_services(load_rig_file(config).zenoh)
    wrong = problems(roll, expected, stopped)
    if not living and not expected and not wrong:
        raise nothing_heard(look.site, seconds)
    return SiteState(living, wrong)


def expected_instances(config: Path | None) -> tuple[Instance, ...]:
    """Whom the settings file names; raises SettingsError."""
    rig_file = load_rig_file(config)
    return tuple((service, name) for service in SERVICES for name in getattr(rig_file, service))


def _listen(look: Look, roll: Roll, expected: tuple[Instance, ...], seconds: float | None) -> None:
    remarks: set[str] = set()
    for sample in look.samples(seconds):
        if sample is not None:
            try:
                roll.hear(HEALTH.received(sample.key, sample.payload, sample.encoding))
            except (MessageError, KeyFormatError) as error:
                if (remark := printable(f"{sample.key}: {error}")) not in remarks:
                    remarks.add(remark)
                    print(remark, file=sys.stderr)
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
            shown_state(health),
            f"{health.uptime_s:.0f}",
            f"{health.resident_bytes / 1e6:.0f}",
            "" if latency is None else f"{latency.p50:.1f} / {latency.p99:.1f}",
            f"{sum(topic.rate_hz for topic in health.topics.values()):.1f}",
            str(sum(unused_counts(health).values())),
        )
    return table
