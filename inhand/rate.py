"""``inhand rate``: measure rates, sizes, delays and gaps of what a site publishes."""

import argparse
import contextlib
import statistics
from collections import deque
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import msgspec
from inhand_recorder.losses import LossCounter
from inhand_runtime.inbox import Received
from inhand_runtime.roll import short_key
from inhand_schemas.messages import Message
from inhand_schemas.topics import AnyTopic, topic_of
from rich.live import Live
from rich.table import Table

from inhand.looking import (
    add_looking_arguments,
    nothing_heard,
    open_look,
    output,
    stream_and_name,
    unreadable,
)
from inhand.results import listing, write_json

WINDOW_SAMPLES = 300
LONGEST_DELAY_MS = 60_000.0
"""Milliseconds from which on a delay is no delay: a recording is replayed, or a clock is wrong."""
NO_DELAY = "-"

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
        with _shown(meter):
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
        except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
            return
        self._losses.count(sample.key, stamp.sequence)
        window = self._window.setdefault(sample.key, deque(maxlen=WINDOW_SAMPLES))
        window.append((sample.received_ns, stamp.time_ns, len(sample.payload)))

    def rates(self) -> dict[str, dict[str, Any]]:
        """Return by key: messages, rate in Hz, longest pause and median delay in ms, bytes, losses.

        The delay is None where it says nothing of the way from the publisher to here.
        """
        losses = self._losses.losses()
        rates = {}
        for key, window in sorted(self._window.items()):
            topic, _ = topic_of(key)
            received, captured, sizes = zip(*window, strict=True)
            seconds = (received[-1] - received[0]) / 1e9
            pauses = [after - before for before, after in pairwise(received)]
            rates[key] = {
                "messages": losses[key].received,
                "rate_hz": len(pauses) / seconds if seconds > 0 else 0.0,
                "longest_pause_ms": max(pauses, default=0) / 1e6,
                "delay_ms": _delay_ms(topic, received, captured),
                "bytes": round(statistics.mean(sizes)),
                "lost": losses[key].lost if topic.gaps_are_losses else 0,
            }
        return rates


def _delay_ms(topic: AnyTopic, received: Sequence[int], captured: Sequence[int]) -> float | None:
    """Median time since capture; None for a kept value, which is handed to whoever comes later, and
    for what was captured at another time."""
    if topic.delivery.kept:
        return None
    delay_ms = statistics.median(map(int.__sub__, received, captured)) / 1e6
    return delay_ms if abs(delay_ms) < LONGEST_DELAY_MS else None


@contextlib.contextmanager
def _shown(meter: Meter) -> Iterator[None]:
    """Show what is measured: all the time on a terminal, and once at the end elsewhere."""
    console = output()
    if console.is_terminal:
        renderable = partial(_so_far, meter)
        with Live(console=console, get_renderable=renderable, refresh_per_second=2):
            yield
        return
    try:
        yield
    finally:
        if rates := meter.rates():
            console.print(rates_table(rates))


def _so_far(meter: Meter) -> Table | str:
    rates = meter.rates()
    return rates_table(rates) if rates else "nothing heard yet"


def rates_table(rates: dict[str, dict[str, Any]]) -> Table:
    """One row a key; no key is cut on a narrow terminal."""
    numbers = ("messages", "Hz", "pause\nms", "delay\nms", "bytes", "lost")
    table = listing(("topic",), numbers)
    for key, rate in rates.items():
        delay_ms = rate["delay_ms"]
        table.add_row(
            short_key(key),
            str(rate["messages"]),
            f"{rate['rate_hz']:.1f}",
            f"{rate['longest_pause_ms']:.1f}",
            NO_DELAY if delay_ms is None else f"{delay_ms:.1f}",
            f"{rate['bytes']:,}",
            str(rate["lost"]),
        )
        if delay_ms is None:
            table.caption = f"{NO_DELAY}: a kept value, or of another time, as in a replay"
    return table
