"""What it costs to be watched, and how fast recordings open: measured, not judged.

``python tests/scenes/watched.py live`` lets a simulated rig run at 640 × 480 and 30 frames a
second, with nobody, one viewer, three, and three beside one that is stuck, in turns, and prints how
old poses are when they are published, what viewers get, and what the studio takes. ``paint`` opens
tabs in Chromium. ``recording`` writes one of ``--hours``, opens it and jumps about in it. What else
runs on the machine changes all of it: the load is printed, and figures are compared within one run.
"""

import argparse
import os
import statistics
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import psutil
from answering_viewer import Viewer, looking
from browser import chromium, tab
from examples import PERSON
from inhand_runtime.pixels import encode_colour
from inhand_runtime.recording import RecordingWriter
from inhand_schemas.keys import Site
from inhand_schemas.messages import CameraInfo, Message, ObjectPose, Pose, RgbdFrame, Skeletons
from inhand_schemas.topics import HEALTH, INFO, LABEL, POSE, RGBD, SKELETONS, Topic
from inhand_studio.labelling_page.opened import OpenedRecording
from inhand_studio.review_page.estimates import Estimates
from inhand_studio.review_page.parameters import DEFAULT_REVIEW
from inhand_studio.review_page.recording import ReviewedRecording
from inhand_studio.shapes import Shapes
from running_rig import Process, RunningRig
from wire import Wire

SETTLING_S = 3.0
ROUNDS = 2
JUMPS = 1000
START_NS = 1_700_000_000_000_000_000
FRAME_NS = 33_333_333
INFO_OF_CAMERA = CameraInfo(
    sequence=0, time_ns=1, width=640, height=480, fx=550.0, fy=550.0, cx=319.5, cy=239.5
)


def main() -> None:
    """Measure what the command line names."""
    parser = argparse.ArgumentParser()
    parser.add_argument("what", choices=("live", "paint", "recording"))
    parser.add_argument("--seconds", type=float, default=10.0, help="of each turn of live (10)")
    parser.add_argument("--hours", type=float, default=2.0, help="of the recording (2)")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        if chosen.what == "recording":
            _measure_recording(Path(folder), chosen.hours)
        else:
            _with_rig(Path(folder), chosen)
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")


def _with_rig(folder: Path, chosen: argparse.Namespace) -> None:
    rig = RunningRig(folder)
    try:
        people, model = folder / "people", folder / "mug.model"
        three = ["--interactions", "drinkFromMug", "--participants", "3", "--frames", "300"]
        for verb in (["simulate", people, *three], ["train", people, "-o", model]):
            made = rig.inhand(*verb)
            assert made.popen.wait(600.0) == 0, made.stderr
        rig.configure(
            '[capture.camera]\nsource = "simulator"\n'
            'options = { interaction = "drinkFromMug", participant = 100, seed = 7 }\n'
            f'[tracker.follower]\ncamera = "camera"\nmodel = "{model}"\n'
            f'[studio.page]\ndataset = "{people}"\nport = 0\n'
        )
        processes = {name: rig.inhand(name, "--config", rig.config) for name in _SERVICES}
        processes["studio"].said("the studio is at ")
        url = processes["studio"].stderr.split("the studio is at ")[1].split()[0]
        with Wire.at(rig.meeting) as wire:
            if chosen.what == "paint":
                _measure_paint(url)
            else:
                _measure_live(wire, processes["studio"], url, chosen.seconds)
    finally:
        rig.close()


_SERVICES = ("tracker", "studio", "capture")


def _measure_live(wire: Wire, studio: Process, url: str, seconds: float) -> None:
    heard, health = wire.hear(POSE), wire.hear(HEALTH)
    seen = psutil.Process(studio.pid)
    rows: dict[str, list[tuple[float, ...]]] = {}
    turns: dict[str, Callable[[], list[Viewer]]] = {
        "nobody": list,
        "one viewer": lambda: [Viewer(url)],
        "three viewers": lambda: [Viewer(url) for _ in range(3)],
        "three and a stuck one": lambda: [Viewer(url, reads=number < 3) for number in range(4)],
    }
    time.sleep(20.0)  # what is compiled at the first frames is, by then
    for _ in range(ROUNDS):
        for name, viewers_of in turns.items():
            viewers = viewers_of()
            with looking(viewers):
                time.sleep(SETTLING_S)
                heard.clear()
                before = sum(seen.cpu_times()[:2]), [(v.pictures, v.size) for v in viewers]
                time.sleep(seconds)
                spent_s = sum(seen.cpu_times()[:2]) - before[0]
                poses = len(heard)
                told = [HEALTH.decode(one.payload) for one in health[-20:]]
                # By the tracker itself: this process is busy with its viewers.
                ages_ms = next(one.latency_ms for one in told[::-1] if one.service == "tracker")
                assert ages_ms is not None
                got = [
                    ((v.pictures - p) / seconds, (v.size - s) / seconds)
                    for v, (p, s) in zip(viewers, before[1], strict=True)
                    if v.reads
                ]
            rows.setdefault(name, []).append(
                (
                    ages_ms.p50,
                    ages_ms.p99,
                    poses / seconds,
                    min((pictures for pictures, _ in got), default=0.0),
                    statistics.mean([size for _, size in got] or [0.0]) / 1e6,
                    100.0 * spent_s / seconds,
                    seen.memory_info().rss / 1e6,
                )
            )
    print("medians of turns: pose's age ms, its 99 %, poses/s; pictures/s of the slowest viewer,")
    print("MB/s of each; the studio's CPU in % of a core, and its MB")
    for name, turn in rows.items():
        print(
            f"{name:22}",
            *(f"{statistics.median(column):8.1f}" for column in zip(*turn, strict=True)),
        )


def _measure_paint(url: str) -> None:
    with chromium() as browser:
        for _ in range(3):
            with tab(browser, "about:blank") as page:
                began = time.monotonic()
                page.goto(url, wait_until="commit")
                page.get_by_text("Camera", exact=True).first.wait_for()
                menu_s = time.monotonic() - began
                page.get_by_text("mug of person").first.wait_for()
                row_s = time.monotonic() - began
                paint: Any = page.evaluate(
                    "performance.getEntriesByName('first-contentful-paint')[0].startTime"
                )
            print(f"first paint {paint / 1e3:.2f} s after the address was given, the page's menu")
            print(f"{menu_s:.2f} s, the object's row {row_s:.2f} s")


def _measure_recording(folder: Path, hours: float) -> None:
    path = folder / "long.mcap"
    frames = round(hours * 3600e9 / FRAME_NS)
    began = time.monotonic()
    _write(path, frames)
    size_mb = path.stat().st_size / 1e6
    print(f"{frames} frames, {size_mb:.0f} MB, written in {time.monotonic() - began:.0f} s")
    began = time.monotonic()
    recording = ReviewedRecording(path)
    _jump(recording, 0)
    opened = time.monotonic()
    print(f"opened, with its first frame, in {time.monotonic() - began:.2f} s")
    random = np.random.default_rng(1)
    process = psutil.Process()
    times_s, sizes = [], []
    # As on the page, what errors are made of is read meanwhile.
    estimates = Estimates(recording, Shapes(folder), DEFAULT_REVIEW)
    reading = threading.Thread(target=estimates.read, args=(lambda _: True,))
    reading.start()
    for frame in random.integers(len(recording), size=JUMPS).tolist():
        began = time.monotonic()
        _jump(recording, frame)
        times_s.append(time.monotonic() - began)
        sizes.append(process.memory_info().rss / 1e6)
    median_ms, worst_ms = 1e3 * statistics.median(times_s), 1e3 * max(times_s)
    print(f"{JUMPS} jumps: median {median_ms:.1f} ms, worst {worst_ms:.1f} ms")
    half = JUMPS // 2
    print(f"memory after {half} jumps {sizes[half]:.1f} MB, after {JUMPS} {sizes[-1]:.1f} MB")
    reading.join()
    print(f"all labels and poses were read {time.monotonic() - opened:.0f} s after it was opened")
    recording.close()
    began = time.monotonic()
    labelled = OpenedRecording(path)
    assert labelled.image(len(labelled) // 2) is not None
    print(f"for labelling it was open, with a frame, in {time.monotonic() - began:.2f} s")
    labelled.close()


def _jump(recording: ReviewedRecording, frame: int) -> None:
    """Read all that a page shows of a frame."""
    picture = recording.picture(frame)
    assert picture is not None
    assert picture.colour(INFO_OF_CAMERA) is not None
    assert recording.people(frame)
    time_ns = int(recording.times_ns[frame])
    assert recording.labels["mug"].at(time_ns)
    assert recording.poses["mug"].at(time_ns)


def _write(path: Path, frames: int) -> None:
    """Record so many frames of a camera with small pictures, skeletons, labels and poses."""
    site, colour = Site(), encode_colour(np.zeros((48, 64, 3), np.uint8))
    place = Pose((0.0, 0.0, 2.0), (1.0, 0.0, 0.0, 0.0))
    with RecordingWriter(path) as writer:

        def add(topic: Topic[Any], name: str, message: Message) -> None:
            writer.write(
                topic.key(site, name),
                topic.encode(message),
                received_ns=max(message.time_ns, START_NS),
                captured_ns=message.time_ns,
                sequence=message.sequence,
            )

        add(INFO, "camera", INFO_OF_CAMERA)
        for sequence in range(frames):
            time_ns = START_NS + sequence * FRAME_NS
            pose = ObjectPose(
                sequence=sequence,
                time_ns=time_ns,
                object="mug",
                camera="camera",
                state="tracked",
                confidence=1.0,
                camera_from_object=place,
            )
            people = Skeletons(sequence=sequence, time_ns=time_ns, people=(PERSON,))
            add(SKELETONS, "camera", people)
            add(RGBD, "camera", RgbdFrame(sequence=sequence, time_ns=time_ns, colour=colour))
            add(LABEL, "mug", pose)
            add(POSE, "mug", pose)


if __name__ == "__main__":
    main()
