"""What ``status_under_faults.py`` needs to make a fault and to print what a person reads of it."""

import contextlib
import itertools
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from inhand_recorder.clock import CLOCK_RECORD, format_clock_steps
from inhand_runtime.recording import RecordingWriter, read_recording
from inhand_schemas.messages import CameraInfo, RgbdFrame
from inhand_schemas.topics import INFO, RGBD, SKELETONS
from msgspec.structs import replace
from recordings import POSE_KEY, START_NS, frame_messages
from running_rig import Process, RunningRig
from wire import Wire

CAMERA = "camera"
CAMERA_HZ = 15.0
SECOND_NS = 10**9
UNDECODABLE = b"\xc1"
"""The one byte that MessagePack never uses."""
LONGEST_S = 600.0
"""Seconds that simulating or learning may take where kernels are compiled first."""


@dataclass(frozen=True)
class Scene:
    """A rig in which nothing runs yet, and what was made for all: a recording and a model."""

    rig: RunningRig
    recording: Path
    model: Path

    def configure(self, *sections: str) -> None:
        """Write the settings of a recorder and of these sections."""
        disk = f'[recorder.disk]\nfolder = "{self.rig.folder}/disk"'
        self.rig.configure("\n".join((disk, *sections)))

    def tracker(self, name: str = "mug") -> str:
        """The settings of a tracker."""
        return f'[tracker.{name}]\ncamera = "{CAMERA}"\nmodel = "{self.model}"'

    def capture(self, rate: float = 1.0) -> str:
        """The settings of a camera that is the recording over and over."""
        options = f'{{ file = "{self.recording}", loop = true, rate = {rate} }}'
        return f'[capture.{CAMERA}]\nsource = "replay"\noptions = {options}'

    def start(self, service: str, *more: str) -> Process:
        """Start a daemon, and wait until it is up."""
        process = self.rig.inhand(service, "--config", self.rig.config, *more)
        process.said("is up")
        return process

    def status(self) -> None:
        """Print what ``inhand status`` prints."""
        self.show("status", "--config", self.rig.config)

    def show(self, *arguments: str | Path) -> None:
        """Print a command, what it prints, and its exit code."""
        told(arguments, self.rig.done(*arguments))


def told(arguments: tuple[str | Path, ...], process: Process) -> None:
    """Print what an ended process printed."""
    print(f"$ inhand {' '.join(map(str, arguments))}")
    print(process.stdout + process.stderr, end="")
    print(f"exit code {process.popen.returncode}\n", flush=True)


@contextlib.contextmanager
def sending(send: Callable[[int], None], rate_hz: float = CAMERA_HZ) -> Iterator[None]:
    """Call ``send`` with 0, 1, … at this rate meanwhile; raises at the end what it raised."""
    stop = threading.Event()

    def work() -> None:
        for number in itertools.count():
            if stop.wait(1.0 / rate_hz):
                return
            send(number)

    with ThreadPoolExecutor(1) as pool:
        working = pool.submit(work)
        try:
            yield
        finally:
            stop.set()
        working.result()


@contextlib.contextmanager
def calibrated(scene: Scene, wire: Wire) -> Iterator[None]:
    """Send the info of the recording's camera meanwhile, each second, as a daemon repeats it."""
    (info,) = (one.message() for one in read_recording(scene.recording, streams=(INFO.stream,)))
    assert isinstance(info, CameraInfo)
    publisher, as_of_now = wire.publisher(INFO, CAMERA), replace(info, time_ns=time.time_ns())
    with sending(lambda _number: publisher.put(as_of_now), rate_hz=1.0):
        yield


def camera(
    scene: Scene, wire: Wire, changed: Callable[[RgbdFrame], RgbdFrame] = lambda frame: frame
) -> Callable[[int], None]:
    """What sends the recording's moments as of now, with its frames changed."""
    topics = (SKELETONS, RGBD)
    publishers = {topic: wire.publisher(topic, CAMERA) for topic in topics}  # type: ignore[type-var]
    moments: dict[int, list[tuple[object, object]]] = {}
    for one in read_recording(scene.recording, streams=tuple(topic.stream for topic in topics)):
        message = one.message()
        moments.setdefault(message.sequence, []).append((one.topic, message))
    in_order = [moments[number] for number in sorted(moments)]

    def send(number: int) -> None:
        stamp = {"sequence": number, "time_ns": time.time_ns()}
        for topic, message in in_order[number % len(in_order)]:
            sent = replace(message, **stamp)
            publishers[topic].put(changed(sent) if isinstance(sent, RgbdFrame) else sent)

    return send


def made(folder: Path) -> tuple[Path, Path]:
    """Simulate people and learn from all but one; returns that one's recording and the model."""
    rig = RunningRig(folder)
    people, model = folder / "people", folder / "mug.model"
    arguments = ["--interactions", "drinkFromMug", "--participants", "3", "--frames", "60"]
    try:
        for verb in (
            ("simulate", people, *arguments),
            ("train", people, "-o", model, "--without", "p00"),
        ):
            process = rig.inhand(*verb)  # may compile first
            assert process.popen.wait(LONGEST_S) == 0, process.stderr
    finally:
        rig.close()
    return sorted((people / "recordings").glob("*p00*.mcap"))[0], model


def with_an_undecodable_pose(path: Path) -> Path:
    """A recording of ten poses of which one cannot be decoded, as older releases wrote it."""
    with RecordingWriter(path) as writer:
        for number in range(10):
            payload = UNDECODABLE if number == 5 else frame_messages(number, 1)[2][2]
            stamp_ns = START_NS + number * SECOND_NS // 10
            stamps = {"received_ns": stamp_ns, "captured_ns": stamp_ns, "sequence": number}
            writer.write(POSE_KEY, payload, **stamps)
    return path


def with_the_clock_set_back(path: Path, noted: bool) -> Path:
    """A recording in which reception times go back by an hour after the third of six poses."""
    with RecordingWriter(path) as writer:
        for number in range(6):
            captured_ns = START_NS + number * SECOND_NS
            writer.write(
                POSE_KEY,
                frame_messages(number, 1)[2][2],
                received_ns=captured_ns - (3600 * SECOND_NS if number >= 3 else 0),
                captured_ns=captured_ns,
                sequence=number,
            )
        if noted:
            steps = {START_NS + 3 * SECOND_NS: -3600 * SECOND_NS}
            writer.add_metadata(CLOCK_RECORD, format_clock_steps(steps))
    return path
