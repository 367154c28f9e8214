"""``inhand echo``: print messages as they arrive, read with nothing but the msgpack package."""

import argparse
import json
import sys
from collections.abc import Iterator
from typing import Any

import msgpack
from inhand_runtime.inbox import Received
from inhand_runtime.wording import counted, printable
from rich.console import Console
from rich.pretty import pretty_repr

from inhand.looking import (
    Look,
    add_looking_arguments,
    nothing_heard,
    open_look,
    positive_count,
    stream_and_name,
    unreadable,
)

DEEPEST = 64
"""Lists and maps in each other, at the most, that a message is shown with."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument(
        "topic", nargs="?", metavar="STREAM[/NAME]", help="pose/mug, say (default: everything)"
    )
    parser.add_argument(
        "--count", type=positive_count, metavar="N", help="end after so many messages"
    )
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    add_looking_arguments(parser, None)


def run(arguments: argparse.Namespace) -> int:
    """Print until the count, the time or Ctrl-C ends it; raises InhandError on silence."""
    show = _as_json if arguments.json else _as_text
    printed = 0
    with open_look(arguments.config) as look:
        if arguments.topic is None:
            look.follow_all()
        else:
            look.follow(*stream_and_name(arguments.topic))
        for sample, message in _readable(look, arguments.seconds):
            print(show(sample.key, message), flush=True)
            printed += 1
            if printed == arguments.count:
                break
    if not printed:
        raise nothing_heard(look.site, arguments.seconds)
    return 0


def _readable(look: Look, seconds: float | None) -> Iterator[tuple[Received, Any]]:
    remarks: set[str] = set()
    for sample in look.samples(seconds):
        if sample is None:
            continue
        remark = unreadable(sample)
        if remark is None:
            try:
                yield sample, _shown(msgpack.unpackb(sample.payload))
                continue
            except ValueError as error:
                remark = f"{sample.key}: no MessagePack: {error}"
        if remark not in remarks:
            remarks.add(remark)
            print(printable(remark), file=sys.stderr)


def _as_json(key: str, message: Any) -> str:
    return json.dumps({"key": key, "message": message})


def _as_text(key: str, message: Any) -> str:
    width = Console().width
    return f"{key}\n{pretty_repr(message, max_width=width)}"


def _shown(value: Any, depth: int = 0) -> Any:
    """Return a message with sizes in place of bytes; raises ValueError for what none of ours is."""
    if depth > DEEPEST:
        raise ValueError("it is nested too deep")
    if isinstance(value, bytes):
        return f"<{counted(len(value), 'byte')}>"
    if isinstance(value, list):
        return [_shown(item, depth + 1) for item in value]
    if isinstance(value, dict):
        if not all(isinstance(key, str) for key in value):
            raise ValueError("a name in it is no text")
        return {key: _shown(item, depth + 1) for key, item in value.items()}
    if value is None or isinstance(value, bool | int | float | str):
        return value
    raise ValueError(f"it holds a {type(value).__name__}")
