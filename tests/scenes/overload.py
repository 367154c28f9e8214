"""Gives a tracker more than it can do, and looks how old its poses become and what they are worth.

``python tests/scenes/overload.py``: a recording with pictures of somebody who was not learned from
is replayed at its rate, at three times its rate, and beside a busy loop on each core; then the
demonstration runs with all cores, and pinned to one. A line each: skeletons that came, how many of
them were skipped, messages that were lost on their way to the recorder, the age of poses, the
tracker's last effort, and the error against the labels.

A replayed pose's age is the time from its skeleton to itself, both as they reach the recorder: the
skeleton is sent when the replayed camera captures it. A demonstration's is from capture to the
recorder. Exit code 1 where skeletons are neither tracked nor skipped, the error is more than 1.5
times that of the same at leisure, or a demonstration on one core is later than 100 ms.
"""

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_lab.demonstration.review import Review, review
from inhand_runtime.recording import read_recording
from inhand_schemas.messages import Health
from inhand_schemas.topics import HEALTH, POSE, SKELETONS
from inhand_tracker import load_model
from running_rig import Process, RunningRig, eventually

INTERACTION = "drinkFromMug"
MOST_ERROR = 1.5
LATEST_MS = 100.0
LONGEST_S = 1800.0
"""Seconds that a process may take on a busy machine."""
UNDER_WAY = 3
"""Number of skeletons that may be on their way at the end of a demonstration."""


@dataclass(frozen=True)
class Row:
    """What was seen in one case; ages in milliseconds, the error in centimetres.

    ``lost`` is how many messages of any stream did not reach the recorder.
    """

    case: str
    skeletons: int
    poses: int
    skipped: int
    lost: int
    age_p50: float
    age_p99: float
    effort: float
    error_cm: float

    def line(self) -> str:
        """The row of the table."""
        return (
            f"{self.case:32} {self.skeletons:9} {self.skipped:7} {self.lost:5} "
            f"{self.age_p50:8.1f} {self.age_p99:8.1f} {self.effort:7.2f} {self.error_cm:8.2f}"
        )


Ages = Callable[[Path, Review], Iterable[float]]
"""Milliseconds that each pose of a recording is old."""

TITLE = f"{'':32} skeletons skipped  lost  age p50  p99, ms  effort error, cm"


def prepare(rig: RunningRig, frames: int) -> tuple[Path, Path]:
    """Simulate people, learn from all but one, and return the model and that one's recording."""
    people, model = rig.folder / "people", rig.folder / "mug.model"
    arguments = ["--interactions", INTERACTION, "--participants", "5", "--frames", str(frames)]
    finish(rig.inhand("simulate", people, *arguments))
    finish(rig.inhand("train", people, "-o", model, "--without", "p00"))
    return model, sorted((people / "recordings").glob("*p00*.mcap"))[0]


def finish(process: Process) -> None:
    """Wait for the end of a process, which must be a good one."""
    assert process.popen.wait(LONGEST_S) == 0, process.stderr


def replayed(rig: RunningRig, case: str, model: Path, recording: Path, rate: float) -> Row:
    """Replay once, and wait until all is tracked or skipped."""
    disk = rig.folder / case.replace(" ", "_")
    rig.configure(
        f'[capture.camera]\nsource = "replay"\nwait_for_reader_s = 60\n'
        f'options = {{ file = "{recording}", rate = {rate} }}\n'
        f'[tracker.mug]\nmodel = "{model}"\n[recorder.disk]\nfolder = "{disk}"'
    )
    up = rig.inhand("up", "--config", rig.config)
    up.said("capture camera ended with exit code 0")
    sent = sum(1 for _ in read_recording(recording, streams=(SKELETONS.stream,)))
    eventually("every skeleton tracked or skipped", lambda: tracked_or_skipped(rig) == sent)
    assert up.stop() == 0
    (recorded,) = disk.glob("*.mcap")
    shape = load_model(model).shape
    return row(case, recorded, review(recorded, shape.name, shape.marked_vertices), replayed_ages)


def tracked_or_skipped(rig: RunningRig) -> int:
    """Number of skeletons that the tracker has done with."""
    topics = rig.health("mug")["topics"]
    poses = sum(one["published"] for key, one in topics.items() if "/pose/" in key)
    return poses + sum(one["dropped"] for key, one in topics.items() if "/skeletons/" in key)


def replayed_ages(recorded: Path, _seen: Review) -> Iterable[float]:
    """Milliseconds from each skeleton to its pose."""
    arrived: dict[int, int] = {}
    for one in read_recording(recorded, streams=(SKELETONS.stream, POSE.stream)):
        number = one.message().sequence
        if one.topic is SKELETONS:
            arrived[number] = one.received_ns
        elif number in arrived:
            yield (one.received_ns - arrived[number]) / 1e6


def demonstrated_ages(_recorded: Path, seen: Review) -> Iterable[float]:
    """Milliseconds from each capture to its pose at the recorder."""
    return map(float, seen.latencies_ms)


def demonstrated(rig: RunningRig, case: str, cores: set[int]) -> Row:
    """Run the demonstration on some cores."""
    result, before = rig.folder / f"{len(cores)}_cores.json", os.sched_getaffinity(0)
    os.sched_setaffinity(0, cores)
    try:
        demo = rig.inhand("demo", "--folder", rig.folder / "demo", "--json", result)
    finally:
        os.sched_setaffinity(0, before)
    demo.popen.wait(LONGEST_S)
    assert result.exists(), demo.stderr
    recorded = Path(json.loads(result.read_text())["recording"])
    shape = load_model(next(recorded.parents[1].glob("*.model"))).shape
    seen = review(recorded, shape.name, shape.marked_vertices)
    return row(case, recorded, seen, demonstrated_ages)


def row(case: str, recorded: Path, seen: Review, ages: Ages) -> Row:
    """What a recording shows."""
    efforts = [
        health.effort
        for one in read_recording(recorded, streams=(HEALTH.stream,))
        if isinstance(health := one.message(), Health) and health.effort is not None
    ]
    p50, p99 = np.percentile(list(ages(recorded, seen)), (50, 99)).tolist()
    return Row(
        case,
        seen.traffic[SKELETONS.stream].published,
        seen.traffic[POSE.stream].published,
        seen.skipped_frames,
        sum(one.lost for one in seen.traffic.values()),
        p50,
        p99,
        efforts[-1],
        100.0 * float(seen.vertex_errors_m.mean()),
    )


def wrong(seen: Row, at_leisure: Row, *, latest_ms: float = float("inf")) -> list[str]:
    """What of a row breaks a promise."""
    lines = []
    if not 0 <= seen.skeletons - seen.poses - seen.skipped <= UNDER_WAY:
        lines.append(f"{seen.case}: skeletons are neither tracked nor skipped")
    if seen.error_cm > MOST_ERROR * at_leisure.error_cm:
        lines.append(f"{seen.case}: the error is {seen.error_cm / at_leisure.error_cm:.2f} times")
    if seen.age_p99 > latest_ms:
        lines.append(f"{seen.case}: poses are {seen.age_p99:.0f} ms old")
    return lines


def main() -> int:
    """Run every case once."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=450, help="frames of the recording")
    parser.add_argument("--demos", type=int, default=1, help="demonstrations on one core")
    chosen = parser.parse_args()
    broken: list[str] = []
    all_cores = os.sched_getaffinity(0)
    with tempfile.TemporaryDirectory() as folder:
        rig = RunningRig(Path(folder))
        try:
            model, recording = prepare(rig, chosen.frames)
            print(TITLE, flush=True)
            leisure = replayed(rig, "replay", model, recording, 1.0)
            print(leisure.line(), flush=True)
            fast = replayed(rig, "replay at rate 3", model, recording, 3.0)
            print(fast.line(), flush=True)
            loops = [rig.python("-c", "while True: pass") for _ in all_cores]
            busy = replayed(rig, "replay, a busy loop on each core", model, recording, 1.0)
            print(busy.line(), flush=True)
            for loop in loops:
                loop.popen.kill()
                loop.wait()
            for one in (fast, busy):
                broken += wrong(one, leisure)
            usual = demonstrated(rig, "demonstration", all_cores)
            print(usual.line(), flush=True)
            for _ in range(chosen.demos):
                pinned = demonstrated(rig, "demonstration on one core", {min(all_cores)})
                print(pinned.line(), flush=True)
                broken += wrong(pinned, usual, latest_ms=LATEST_MS)
        finally:
            rig.close()
    for line in broken:
        print(f"WRONG: {line}")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
