"""``inhand bench recorder``: what recording costs, beside writers that others made.

Writers are handed the same encoded messages of a rig, one after the other as fast as they take
them, in turns. Then recorders run as they do in a rig, and are sent to at its rate.
"""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from inhand_lab.benchmarks import hub_ends
from inhand_lab.benchmarks.hub_cost import rig_streams, turned
from inhand_lab.benchmarks.hub_ends import PUBLISHED, Load, RigEnds, Stream
from inhand_lab.benchmarks.parameters import DEFAULT_HUB_COST, RecorderCostParameters
from inhand_lab.demonstration.preparation import free_port
from inhand_recorder.inspection import inspect_recording
from inhand_recorder.journal import Journal
from inhand_recorder.recording_file import Limits
from inhand_recorder.recording_loop import HAND_OVER_PERIOD_S, SYNC_PERIOD_S
from inhand_recorder.stamps import entry_of
from inhand_runtime.errors import InhandError
from inhand_runtime.inbox import Received
from inhand_runtime.settings import ZenohSettings
from inhand_runtime.supervisor_watch import supervised
from inhand_schemas.keys import Site, parse_key
from inhand_schemas.topics import PREVIEW, TOPICS
from mcap.writer import CompressionType, Writer
from rich.table import Table

SITE = Site("bench", "rig")
UNRECORDED = {PREVIEW.stream}
"""Streams that a recorder takes only where its settings ask for them."""


@dataclass(frozen=True)
class WriterSpeed:
    """How fast a writer took the messages, in each turn, and the processor time that they took."""

    name: str
    messages_per_second: tuple[float, ...]
    megabytes_per_second: tuple[float, ...]
    cpu_s: tuple[float, ...]


@dataclass(frozen=True)
class RecorderCost:
    """Some recorders, of a rig each: cores and MB of all, and what was sent and not recorded."""

    rigs: int
    cores: float
    mb: float
    sent: int
    lost: int


@dataclass(frozen=True)
class RecorderCosts:
    """All of it."""

    writers: tuple[WriterSpeed, ...]
    recorders: tuple[RecorderCost, ...]

    def ratio(self, writer: WriterSpeed, measure: str) -> float:
        """Return the median of how many times as fast as the bare ``mcap`` writer one was in a
        turn, by time passed (``messages_per_second``) or by processor time (``cpu_s``)."""
        own, bare = (np.array(getattr(one, measure)) for one in (writer, self.writers[0]))
        return float(np.median(bare / own if measure == "cpu_s" else own / bare))


def recorder_steps(parameters: RecorderCostParameters) -> int:
    """Return how often ``measure_recorder`` calls ``on_progress``."""
    return parameters.turns + len(parameters.rig_counts)


def measure_recorder(
    on_progress: Callable[[], None], parameters: RecorderCostParameters
) -> RecorderCosts:
    """Measure writers and recorders; raises InhandError."""
    streams = rig_streams(DEFAULT_HUB_COST)
    with tempfile.TemporaryDirectory(prefix="inhand_bench_") as name:
        writers = _writers(Path(name), streams, on_progress, parameters)
        recorders = []
        for count in parameters.rig_counts:
            recorders.append(_recorded(Path(name), count, streams, parameters))
            on_progress()
    return RecorderCosts(writers, tuple(recorders))


def _writers(
    folder: Path,
    streams: Mapping[str, Stream],
    on_progress: Callable[[], None],
    parameters: RecorderCostParameters,
) -> tuple[WriterSpeed, ...]:
    samples = _samples(streams, parameters.written_frames)
    size = sum(len(one.payload) for one in samples)
    taken: dict[str, list[tuple[float, float]]] = {name: [] for name in WRITERS}
    for turn in range(parameters.turns):
        for name in turned(list(WRITERS), turn):
            with tempfile.TemporaryDirectory(dir=folder) as own:
                begin, cpu = time.perf_counter(), time.process_time()
                WRITERS[name](Path(own), samples)
                taken[name].append((time.perf_counter() - begin, time.process_time() - cpu))
        on_progress()
    return tuple(
        WriterSpeed(
            name,
            tuple(len(samples) / seconds for seconds, _ in rows),
            tuple(size / 1e6 / seconds for seconds, _ in rows),
            tuple(cpu for _, cpu in rows),
        )
        for name, rows in taken.items()
    )


def _samples(streams: Mapping[str, Stream], frames: int) -> list[Received]:
    """Encode what a rig publishes with some frames, as it is received."""
    begin_ns, samples = time.time_ns(), []
    for number in range(frames):
        for stream, one in streams.items():
            if stream in UNRECORDED:
                continue
            topic, at_ns = TOPICS[stream], begin_ns + round(number / one.rate * 1e9)
            message = msgspec.structs.replace(one.message, sequence=number, time_ns=at_ns)
            payload = topic.encode(message)  # type: ignore[arg-type]
            samples.append(Received(topic.key(SITE, "one"), payload, topic.encoding, at_ns))
    return samples


def _write_ours(folder: Path, samples: Sequence[Received]) -> None:
    """As the recorder's daemon: each message is checked, and brought to the disk in time."""
    journal = Journal(folder, SITE.rig, Limits(), dict)
    next_sync = time.monotonic() + SYNC_PERIOD_S
    next_hand_over = time.monotonic() + HAND_OVER_PERIOD_S
    for sample in samples:
        journal.write(entry_of(sample))
        if time.monotonic() >= next_hand_over:
            journal.hand_over()
            next_hand_over = time.monotonic() + HAND_OVER_PERIOD_S
        if time.monotonic() >= next_sync:
            journal.sync()
            next_sync = time.monotonic() + SYNC_PERIOD_S
    journal.close()


def _write_bare(folder: Path, samples: Sequence[Received]) -> None:
    with (folder / "bare.mcap").open("wb") as file:
        writer, channels = Writer(file, compression=CompressionType.NONE), dict[str, int]()
        writer.start()
        for sample in samples:
            if sample.key not in channels:
                schema = writer.register_schema(sample.key, "jsonschema", b"{}")
                channels[sample.key] = writer.register_channel(sample.key, "msgpack", schema)
            at_ns = sample.received_ns
            writer.add_message(channels[sample.key], at_ns, sample.payload, at_ns)
        writer.finish()  # type: ignore[no-untyped-call]


def _write_foxglove(folder: Path, samples: Sequence[Received]) -> None:
    from foxglove import Channel, Context, Schema, open_mcap
    from foxglove.mcap import MCAPWriteOptions

    context = Context()
    channels: dict[str, Any] = {}
    path, options = folder / "foxglove.mcap", MCAPWriteOptions(compression=None)
    with open_mcap(path, context=context, writer_options=options):
        for sample in samples:
            if sample.key not in channels:
                schema = Schema(name=sample.key, encoding="jsonschema", data=b"{}")
                channels[sample.key] = Channel(
                    sample.key, message_encoding="msgpack", schema=schema, context=context
                )
            channels[sample.key].log(sample.payload, log_time=sample.received_ns)


WRITERS: dict[str, Callable[[Path, Sequence[Received]], None]] = {
    "mcap's own writer": _write_bare,
    "Inhand's recorder": _write_ours,
    "foxglove-sdk's writer": _write_foxglove,
}
"""What writes a rig's messages into a folder, by name: first what the others are beside."""


def _recorded(
    folder: Path, count: int, streams: Mapping[str, Stream], parameters: RecorderCostParameters
) -> RecorderCost:
    """Let recorders of some rigs record what a process sends."""
    rigs = tuple(bench_rig(number) for number in range(count))
    recorded = {name: one for name, one in streams.items() if name not in UNRECORDED}
    context = get_context("spawn")
    with tempfile.TemporaryDirectory(dir=folder) as name:
        place = Path(name)
        with ExitStack() as stack:
            processes = [stack.enter_context(running_recorder(place, rig)) for rig in rigs]
            load = Load(
                rigs, recorded, parameters.warming_s, parameters.measured_s, tuple(processes)
            )
            ended = (context.Event(),)
            with ProcessPoolExecutor(1, context, hub_ends.begin, ended) as pool:
                sent = pool.submit(hub_ends.send, load).result()
        found = sum(
            key.messages
            for path in place.glob("*/*.mcap")
            for key in inspect_recording(path).keys
            if parse_key(key.key).stream in recorded
        )
    messages = sum(sent.messages.values()) + len(rigs) * sum(map(load.first, recorded))
    return RecorderCost(count, sent.cpu_s / sent.passed_s, sent.mb, messages, messages - found)


def bench_rig(number: int) -> RigEnds:
    """Return a rig of its own number, whose processes meet at a free port of this machine."""
    meeting = f"tcp/127.0.0.1:{free_port()}"
    site = Site(SITE.realm, f"{SITE.rig}_{number}")
    return RigEnds(site, dict.fromkeys(PUBLISHED, ZenohSettings(meeting=meeting)))


@contextmanager
def running_recorder(folder: Path, rig: RigEnds, settings: str = "") -> Iterator[int]:
    """Run the recorder of a rig, into a folder in this one, until the block ends, and give its
    process; ``settings`` are more of its own. Raises InhandError where it failed."""
    name, (meeting, *_) = rig.site.rig, [one.meeting for one in rig.members.values()]
    config = folder / f"{name}.toml"
    config.write_text(
        f'realm = "{rig.site.realm}"\nrig = "{name}"\n[zenoh]\nmeeting = "{meeting}"\n'
        f'[recorder.disk]\nfolder = "{name}"\n{settings}\n',
        encoding="utf-8",
    )
    command = [sys.executable, "-m", "inhand", "recorder", "--config", str(config)]
    with (folder / f"{name}.log").open("wb") as log:
        process = subprocess.Popen(
            command, env={**os.environ, **supervised()}, stdin=subprocess.DEVNULL, stderr=log
        )
    try:
        yield process.pid
    finally:
        process.terminate()
        if process.wait() != 0:
            raise InhandError(f"a recorder failed: {(folder / f'{name}.log').read_text()}")


def writers_table(costs: RecorderCosts) -> Table:
    """A row for each writer."""
    table = Table(title="writing a rig's messages as fast as they are taken, in turns")
    table.add_column("writer")
    for name in ("messages/s", "MB/s", "times mcap's rate", "by processor time"):
        table.add_column(name, justify="right")
    for one in costs.writers:
        table.add_row(
            one.name,
            f"{np.median(one.messages_per_second):,.0f}",
            f"{np.median(one.megabytes_per_second):,.0f}",
            f"{costs.ratio(one, 'messages_per_second'):.2f}",
            f"{costs.ratio(one, 'cpu_s'):.2f}",
        )
    return table


def recorders_table(costs: RecorderCosts) -> Table:
    """A row for each number of rigs."""
    table = Table(title="recorders of one rig each, at 30 frames a second")
    for name in ("rigs", "cores", "cores a rig", "MB", "messages", "lost"):
        table.add_column(name, justify="right")
    for one in costs.recorders:
        table.add_row(
            f"{one.rigs}",
            f"{one.cores:.2f}",
            f"{one.cores / one.rigs:.3f}",
            f"{one.mb:.0f}",
            f"{one.sent:,}",
            f"{one.lost:,}",
        )
    return table
