"""Makes twelve faults, each in a rig of its own, and prints what a person then reads.

``python tests/scenes/status_under_faults.py``: daemons run as processes, something goes wrong, and
``inhand status`` looks; where the fault is one of a file, ``inhand recording`` does. A heading says
what was done, and all that each command printed follows with its exit code. Nothing is judged: that
is for the tests that ``docs/reliability.md`` names. It takes some minutes, and a minute more where
kernels have to be compiled first.
"""

import argparse
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

import msgspec
from faulty_scene import (
    CAMERA,
    UNDECODABLE,
    Scene,
    calibrated,
    camera,
    made,
    sending,
    told,
    with_an_undecodable_pose,
    with_the_clock_set_back,
)
from inhand_recorder.recording_loop import MOST_KEYS
from inhand_schemas.messages import ColourImage, RgbdFrame
from inhand_schemas.topics import INFO, RGBD, SKELETONS
from msgspec.structs import replace
from played import CAMERA_INFO, entries, write
from recordings import frame_messages
from running_rig import RunningRig, eventually
from wire import Wire

TOLD_AFTER_S = 6.0
"""Seconds that a fault lasts before somebody looks; the slowest is told after three."""
PAUSE_S = 10.0


def frames_without_info(scene: Scene) -> None:
    """Frames come, and their camera's info never does; then it does."""
    scene.configure(scene.tracker())
    for service in ("tracker", "recorder"):
        scene.start(service)
    with Wire.at(scene.rig.meeting) as wire, sending(camera(scene, wire)):
        time.sleep(TOLD_AFTER_S)
        scene.status()
        with calibrated(scene, wire):
            time.sleep(TOLD_AFTER_S)
            scene.status()


def tracker_behind(scene: Scene) -> None:
    """A recording with pictures is replayed to a tracker at thirty times its rate."""
    scene.configure(scene.tracker(), scene.capture(rate=30.0))
    for service in ("tracker", "recorder", "capture"):
        scene.start(service)
    time.sleep(TOLD_AFTER_S)
    scene.status()


def enormous_numbers(scene: Scene) -> None:
    """A camera info has a focal length of 1e300, and frames say that they are 16,384 × 16,384;
    then the tracker and the recorder are asked to end."""
    scene.configure(scene.tracker())
    daemons = [scene.start(service) for service in ("tracker", "recorder")]
    info = msgspec.to_builtins(CAMERA_INFO) | {"fx": 1e300}
    small = RgbdFrame(sequence=0, time_ns=0, colour=ColourImage("jpeg", 64, 48, bytes(16_000)))
    frame = msgspec.to_builtins(small, builtin_types=(bytes,))
    frame["colour"] |= {"width": 16_384, "height": 16_384}
    with Wire.at(scene.rig.meeting) as wire:

        def send(number: int) -> None:
            stamp = {"sequence": number, "time_ns": time.time_ns()}
            for topic, message in ((INFO, info), (RGBD, frame)):
                payload = msgspec.msgpack.encode(message | stamp)
                key = topic.key(wire.site, CAMERA)
                wire.session.put(key, payload, encoding=topic.encoding)

        with sending(send):
            time.sleep(TOLD_AFTER_S)
            scene.status()
    ends = [daemon.stop() for daemon in daemons]
    print(f"tracker and recorder ended at SIGTERM with exit codes {ends}\n", flush=True)


def stopped_reader(scene: Scene) -> None:
    """``inhand topics`` is stopped (SIGSTOP) while a camera and a recorder run."""
    scene.configure(scene.capture())
    for service in ("recorder", "capture"):
        scene.start(service)
    arguments = ("topics", "--config", scene.rig.config, "--seconds", "60")
    with Wire.at(scene.rig.meeting) as wire:
        reader = scene.rig.inhand(*arguments)
        eventually("the reader", lambda: wire.knows(3))
        reader.popen.send_signal(signal.SIGSTOP)
        time.sleep(TOLD_AFTER_S)
    scene.status()


def stopped_and_missing_daemon(scene: Scene) -> None:
    """A camera that the settings name was never started, and the recorder is stopped (SIGSTOP):
    while somebody looks, then before somebody looks; last the recorder is killed."""
    scene.configure(scene.tracker(), scene.capture())
    scene.start("tracker")
    recorder = scene.start("recorder")
    arguments = ("status", "--config", scene.rig.config, "--seconds", "9")
    looking = scene.rig.inhand(*arguments)
    time.sleep(3.0)
    recorder.popen.send_signal(signal.SIGSTOP)
    looking.wait()
    told(arguments, looking)
    scene.status()
    recorder.stop(signal.SIGKILL)
    scene.status()


def undecodable_message(scene: Scene) -> None:
    """Skeletons that cannot be decoded come between good ones; then the recording of that, and one
    of an older release, which stored such messages among the others."""
    scene.configure(scene.tracker())
    scene.start("tracker")
    recorder = scene.start("recorder")
    with Wire.at(scene.rig.meeting) as wire:
        good = camera(scene, wire)
        key = SKELETONS.key(wire.site, CAMERA)

        def send(number: int) -> None:
            good(number)
            if number % 5 == 0:
                wire.session.put(key, UNDECODABLE, encoding=SKELETONS.encoding)

        with calibrated(scene, wire), sending(send):
            time.sleep(TOLD_AFTER_S)
            scene.status()
    recorder.stop()
    (recorded,) = (scene.rig.folder / "disk").glob("*.mcap")
    scene.show("recording", "verify", recorded)
    scene.show("recording", "info", recorded)
    old = with_an_undecodable_pose(scene.rig.folder / "old.mcap")
    scene.show("recording", "verify", old)
    scene.show("recording", "recover", old, "-o", scene.rig.folder / "saved.mcap")


def cut_recording(scene: Scene) -> None:
    """A recording of 200 frames is cut off near its end, and one bit of a picture before the cut is
    flipped."""
    data = bytearray(write(scene.rig.folder / "whole.mcap", entries(200)).read_bytes())
    pictures = [at for at in range(len(data)) if data.startswith(b"any bytes", at)]
    data[pictures[150]] ^= 1
    cut = scene.rig.folder / "cut.mcap"
    cut.write_bytes(data[: pictures[180]])
    scene.show("recording", "info", cut)
    scene.show("recording", "verify", cut)
    saved = scene.rig.folder / "saved.mcap"
    scene.show("recording", "recover", cut, "-o", saved)
    scene.show("recording", "verify", saved)


def paused_replay(scene: Scene) -> None:
    """A replay is stopped (SIGSTOP) for ten seconds, and goes on (SIGCONT)."""
    scene.configure()
    scene.start("recorder")
    arguments = (str(scene.recording), "--loop")
    replay = scene.rig.inhand("replay", *arguments, "--config", scene.rig.config)
    with Wire.at(scene.rig.meeting) as wire:
        heard = wire.hear(RGBD)
        eventually("frames", lambda: heard)
        replay.popen.send_signal(signal.SIGSTOP)
        begin = time.monotonic()
        time.sleep(1.0)
        scene.status()
        time.sleep(max(0.0, begin + PAUSE_S - time.monotonic()))
        before = len(heard)
        replay.popen.send_signal(signal.SIGCONT)
        time.sleep(1.0)
        print(f"frames in the second after SIGCONT: {len(heard) - before} (30 is the usual)\n")
    time.sleep(TOLD_AFTER_S)
    scene.status()


def undecodable_pictures(scene: Scene) -> None:
    """The bytes of pictures are no JPEG; then pictures are well again."""
    scene.configure(scene.tracker())
    for service in ("tracker", "recorder"):
        scene.start(service)

    well = threading.Event()

    def spoilt(frame: RgbdFrame) -> RgbdFrame:
        if well.is_set():
            return frame
        return replace(frame, colour=replace(frame.colour, data=b"no picture"))

    with (
        Wire.at(scene.rig.meeting) as wire,
        calibrated(scene, wire),
        sending(camera(scene, wire, spoilt)),
    ):
        time.sleep(TOLD_AFTER_S)
        scene.status()
        well.set()
        time.sleep(2.0 * TOLD_AFTER_S)
        scene.status()


def twins(scene: Scene) -> None:
    """A recorder is started twice; two trackers publish one object; and one of them is started
    again while the first of that name is stopped and cannot answer, and then the first goes on."""
    scene.configure(scene.tracker("one"), scene.tracker("two"))
    scene.start("recorder")
    second = scene.rig.inhand("recorder", "--config", scene.rig.config)
    second.wait()
    told(("recorder", "--config", scene.rig.config), second)
    first, _ = (scene.start("tracker", "--name", name) for name in ("one", "two"))
    at = scene.rig.meeting
    with Wire.at(at) as wire, calibrated(scene, wire), sending(camera(scene, wire)):
        time.sleep(TOLD_AFTER_S)
        scene.status()
        first.popen.send_signal(signal.SIGSTOP)
        meanwhile = scene.start("tracker", "--name", "one")
        first.popen.send_signal(signal.SIGCONT)
        meanwhile.wait()
        told(("tracker", "--config", scene.rig.config, "--name", "one"), meanwhile)
        scene.status()


def ever_new_keys(scene: Scene) -> None:
    """Some program publishes on ever new keys, a thousand more than are recorded and on."""
    scene.configure()
    scene.start("recorder")
    payload = frame_messages(0, 1)[1][2]

    with Wire.at(scene.rig.meeting) as wire:

        def send(number: int) -> None:
            key = SKELETONS.key(wire.site, f"thing_{number}")
            wire.session.put(key, payload, encoding=SKELETONS.encoding)

        eventually("the recorder", lambda: wire.knows(1))
        for number in range(MOST_KEYS + 1000):
            send(number)
            if number % 200 == 199:
                time.sleep(0.05)  # the recorder is attacked, not the link
        with sending(lambda number: send(MOST_KEYS + 1000 + number)):
            time.sleep(TOLD_AFTER_S)
            scene.status()


def clock_set_back(scene: Scene) -> None:
    """The clock was set back by an hour while recording, and the recorder noted it; then the same
    without the note, as older releases wrote it."""
    for name, noted in (("noted", True), ("not_noted", False)):
        path = with_the_clock_set_back(scene.rig.folder / f"{name}.mcap", noted)
        scene.show("recording", "info", path)
        scene.show("recording", "verify", path)


SITUATIONS: tuple[Callable[[Scene], None], ...] = (
    frames_without_info,
    tracker_behind,
    enormous_numbers,
    stopped_reader,
    stopped_and_missing_daemon,
    undecodable_message,
    cut_recording,
    paused_replay,
    undecodable_pictures,
    twins,
    ever_new_keys,
    clock_set_back,
)


def main() -> int:
    """Make one after the other."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    with tempfile.TemporaryDirectory(prefix="inhand-status-") as name:
        folder = Path(name)
        recording, model = made(folder)
        for number, situation in enumerate(SITUATIONS, 1):
            print(f"=== {number}. {' '.join((situation.__doc__ or '').split())}\n", flush=True)
            own = folder / str(number)
            own.mkdir()
            rig = RunningRig(own)
            try:
                situation(Scene(rig, recording, model))
            finally:
                rig.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
