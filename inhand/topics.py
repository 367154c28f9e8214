"""``inhand topics``: list what a running site publishes now."""

import argparse
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from inhand_runtime.roll import short_key
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import Site
from inhand_schemas.topics import topic_of
from rich.table import Table

from inhand.looking import (
    add_looking_arguments,
    nothing_heard,
    open_look,
    output,
    unreadable,
)
from inhand.results import listing, write_json

SECONDS = 3.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    add_looking_arguments(parser, SECONDS)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the list there")


def run(arguments: argparse.Namespace) -> int:
    """Listen for a while, then print a table; raises InhandError when the site is silent."""
    messages: Counter[str] = Counter()
    remarks: dict[str, str | None] = {}
    with open_look(arguments.config) as look:
        look.follow_all()
        for sample in look.samples(arguments.seconds):
            if sample is not None:
                messages[sample.key] += 1
                remarks[sample.key] = unreadable(sample)
    if not messages:
        raise nothing_heard(look.site, arguments.seconds)
    topics = [
        {"key": key, "type": _type_name(key), "messages": messages[key], "remark": remarks[key]}
        for key in sorted(messages)
    ]
    output().print(topics_table(look.site, topics))
    if arguments.json is not None:
        write_json(arguments.json, {"topics": topics})
    return 0


def topics_table(site: Site, topics: Sequence[dict[str, Any]]) -> Table:
    """One row a key; those of this release as ``stream/name``."""
    table = listing(
        ("topic", "message", "remark"), ("heard",), f"rig {site.rig} of realm {site.realm}"
    )
    for topic in topics:
        texts = (short_key(topic["key"]), topic["type"] or "", topic["remark"] or "")
        table.add_row(*texts, str(topic["messages"]))
    return table


def _type_name(key: str) -> str | None:
    try:
        return topic_of(key)[0].message_type.__name__
    except KeyFormatError:
        return None
