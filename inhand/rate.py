"""``inhand rate``: measure rates, sizes, delays and gaps of what a site publishes."""

import argparse
import statistics
from collections import deque
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import msgspec
from inhand_recorder.losses import LossCounter
from inhand_runtime.inbox import Received
from inhand_schemas.messages import Message
from rich.live import Live
from rich.table import Table

from inhand.instances import short_key
from inhand.looking import (
    add_looking_arguments,
    nothing_heard,
    open_look,
    output,
    stream_and_name,
    unreadable,
)
from inhand.results import write_json

WINDOW_SAMPLES = 300

_decoder = msgspec.msgpack.Decoder(Message)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument(
        "topic", nargs="?", metavar="STREAM[/NAME]", help="pose/mug, say (default: everything)"
    )
    add_looking_arguments(parser, None)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there")


def run(arguments: argparse.Namespace) -> int:
    """Measure until the time or Ctrl-C ends it; raises InhandError on silence."""
    meter = Meter()
    with open_look(arguments.config) as look:
        if arguments.topic is None:
            look.follow_all()
        else:
            look.follow(*stream_and_name(arguments.topic))
        renderable = partial(_table, meter)
        with Live(console=output(), get_renderable=renderable, refresh_per_second=2):
            for sample in look.samples(arguments.seconds):
                if sample is not None and unreadable(sample) is None:
                    meter.add(sample)
    rates = meter.rates()
    if not rates:
        raise nothing_heard(look.site, arguments.seconds)
    if arguments.json is not None:
        write_json(arguments.json, {"topics": rates, "skipped": look.skipped})
    return 0


class Meter:
    """Measures each key over its last messages (``WINDOW_SAMPLES``)."""

    def __init__(self) -> None:
        self._losses = LossCounter()
        self._window: dict[str, deque[tuple[int, int, int]]] = {}

    def add(self, sample: Received) -> None:
        """Take note of a message; one without number and time is none."""
        try:
            stamp = _decoder.decode(sample.payload)
        except msgspec.MsgspecError:
            return
        self._losses.count(sample.key, stamp.sequence)
        window = self._window.setdefault(sample.key, deque(maxlen=WINDOW_SAMPLES))
        window.append((sample.received_ns, stamp.time_ns, len(sample.payload)))

    def rates(self) -> dict[str, dict[str, Any]]:
        """By key: messages, rate in Hz, longest pause and median delay in ms, bytes, losses."""
        losses = self._losses.losses()
        rates = {}
        for key, window in sorted(self._window.items()):
            received, captured, sizes = zip(*window, strict=True)
            seconds = (received[-1] - received[0]) / 1e9
            pauses = [after - before for before, after in pairwise(received)]
            rates[key] = {
                "messages": losses[key].received,
                "rate_hz": len(pauses) / seconds if seconds > 0 else 0.0,
                "longest_pause_ms": max(pauses, default=0) / 1e6,
                "delay_ms": statistics.median(map(int.__sub__, received, captured)) / 1e6,
                "bytes": round(statistics.mean(sizes)),
                "lost": losses[key].lost,
            }
        return rates


def _table(meter: Meter) -> Table:
    table = Table("topic", "messages", "Hz", "pause ms", "delay ms", "bytes", "lost")
    for column in table.columns[1:]:
        column.justify = "right"
    for key, rate in meter.rates().items():
        table.add_row(
            short_key(key),
            str(rate["messages"]),
            f"{rate['rate_hz']:.1f}",
            f"{rate['longest_pause_ms']:.1f}",
            f"{rate['delay_ms']:.1f}",
            f"{rate['bytes']:,}",
            str(rate["lost"]),
        )
    return table
