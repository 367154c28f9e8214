"""Lets a recorder record an hour of a rig at ten times its rate, and accounts for each message.

``python tests/scenes/long_recording.py --minutes 6``: a process sends frames, skeletons and poses
of true sizes, 300 of each a second. Finished files are counted and deleted meanwhile. What was sent
has to be recorded, or counted as lost, and the recorder's memory has to be flat.
"""

import argparse
import json
import sys
import tempfile
import threading
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import psutil
from inhand_lab.benchmarks import hub_ends
from inhand_lab.benchmarks.hub_cost import rig_streams
from inhand_lab.benchmarks.hub_ends import Load
from inhand_lab.benchmarks.parameters import DEFAULT_HUB_COST
from inhand_recorder.losses import LOSSES_RECORD, parse_losses
from inhand_runtime.recording import read_metadata
from inhand_schemas.topics import HEALTH, topic_of

from inhand.bench_recorder import UNRECORDED, bench_rig, running_recorder

WARMING_S = 4.0
READING_S = 2.0
MOST_GAINED_MB = 50.0
SETTLED_SHARE = 1.0 / 3.0
"""The part of the time after which memory is expected to be flat."""


def record_long(folder: Path, seconds: float, rate: float) -> dict[str, Any]:
    """Send so long, so many times a rig's rate, and return what became of it."""
    streams = {
        name: replace(one, rate=one.rate * rate)
        for name, one in rig_streams(DEFAULT_HUB_COST).items()
        if name not in UNRECORDED
    }
    rig, context = bench_rig(0), get_context("spawn")
    counts: Counter[str] = Counter()
    readings: list[tuple[float, float]] = []
    with running_recorder(folder, rig, 'split_bytes = "256 MiB"') as pid:
        load = Load((rig,), streams, WARMING_S, seconds, (pid,))
        done = threading.Event()
        reader = threading.Thread(target=_read, args=(folder, pid, counts, readings, done))
        reader.start()
        try:
            with ProcessPoolExecutor(1, context, hub_ends.begin, (context.Event(),)) as pool:
                sent = pool.submit(hub_ends.send, load).result()
        finally:
            done.set()
            reader.join()
    _count(folder, counts)
    messages = sum(sent.messages.values()) + sum(map(load.first, streams))
    settled = np.array(readings[int(len(readings) * SETTLED_SHARE) :])
    return {
        "sent": messages,
        "recorded": counts["received"],
        "lost on the way": counts["lost"] - counts["dropped"],
        "dropped in the queue": counts["dropped"],
        "unaccounted": messages - counts["received"] - counts["lost"],
        "cores": round(sent.cpu_s / sent.passed_s, 2),
        "mb": round(float(settled[-1, 1]), 1),
        "mb an hour": round(3600.0 * float(np.polyfit(*settled.T, 1)[0]), 1),
        "mb gained": round(float(np.median(settled[-10:, 1]) - np.median(settled[:10, 1])), 1),
    }


def _read(
    folder: Path,
    pid: int,
    counts: Counter[str],
    readings: list[tuple[float, float]],
    done: threading.Event,
) -> None:
    process = psutil.Process(pid)
    while not done.wait(READING_S):
        readings.append((time.monotonic(), process.memory_info().rss / 1e6))
        _count(folder, counts)


def _count(folder: Path, counts: Counter[str]) -> None:
    """Count what finished files say of themselves, and delete them."""
    for path in folder.glob("*/*.mcap"):
        for key, losses in parse_losses(read_metadata(path)[LOSSES_RECORD]).items():
            if topic_of(key)[0] is HEALTH:
                continue
            counts["received"] += losses.received
            counts["lost"] += losses.lost + losses.before
            counts["dropped"] += losses.dropped
        path.unlink()


def main() -> int:
    """Exit code 0 where each message is accounted for, and memory was flat."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=6.0)
    parser.add_argument("--rate", type=float, default=10.0, help="times that of a rig")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="inhand_long_") as name:
        seen = record_long(Path(name), 60.0 * arguments.minutes, arguments.rate)
    print(json.dumps(seen, indent=2))
    return int(seen["unaccounted"] != 0 or seen["mb gained"] > MOST_GAINED_MB)


if __name__ == "__main__":
    sys.exit(main())
