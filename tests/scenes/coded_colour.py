"""What colour as H.264 is worth: ``python tests/scenes/coded_colour.py``.

Says how large simulated pictures of 640 × 480 are, and real ones where ``../shared/data`` has any,
as JPEG and as H.264, how near these are to them, and what they and a seek in the middle take. Then
a recorder records a simulated rig at 30 Hz, with either: its processor time, and what it lost.
"""

import argparse
import statistics
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import psutil
from inhand_lab.world.simulation import simulate
from inhand_recorder.colour_encoder import ColourEncoder
from inhand_runtime.pixels import decode_colour, encode_colour, encode_depth
from inhand_runtime.recording.message_index import open_index
from inhand_schemas.messages import CameraInfo, RgbdFrame
from inhand_schemas.topics import INFO, RGBD
from numpy.typing import NDArray
from real_data import DATA
from running_recorder import RGBD_KEY, numbers, recordings, start_recorder
from running_rig import RunningRig, eventually
from wire import Wire

Picture = NDArray[np.uint8]
PERIOD_NS = 33_333_333
ZOOM, STEPS = 1.1, (0.24, 0.10)
"""A real picture is moved by these pixels from one frame to the next, as by a hand-held camera."""
NOISE = 3.0
FRAMES = 120


@dataclass(frozen=True)
class Sequenced:
    """Pictures (H, W, 3) of a camera, one after another."""

    name: str
    pictures: list[Picture]


def simulated(interaction: str) -> Sequenced:
    """Somebody at work, as a simulated Kinect sees it."""
    simulation = simulate(interaction, participant=5, seed=0, frames=FRAMES)
    return Sequenced(interaction, [simulation.render(frame).colour for frame in range(FRAMES)])


def real() -> list[Sequenced]:
    """Real pictures far apart, and the first of them, moved, with noise of the camera's."""
    paths = sorted((DATA / "ycb-video" / "data" / "0000").glob("*-color.png"))
    if not paths:
        return []
    stills = [cv2.cvtColor(cv2.imread(str(path)), cv2.COLOR_BGR2RGB) for path in paths]
    random, moved = np.random.default_rng(0), []
    for number in range(FRAMES // 2):
        shift = [[ZOOM, 0.0, -STEPS[0] * number], [0.0, ZOOM, -STEPS[1] * number]]
        shown = cv2.warpAffine(stills[0], np.array(shift, np.float32), (640, 480))
        noisy = shown + random.normal(0.0, NOISE, shown.shape)
        moved.append(np.clip(noisy, 0, 255).astype(np.uint8))
    return [Sequenced("real, far apart", stills), Sequenced("real, moved", moved)]


def decibels(one: Picture, other: Picture) -> float:
    """The peak signal-to-noise ratio."""
    return float(10 * np.log10(255.0**2 / np.mean((one.astype(float) - other) ** 2)))


def print_quality(of: Sequenced) -> None:
    """Code pictures and print what came of it."""
    import av

    encoder, decoder = ColourEncoder(), av.CodecContext.create("h264", "r")
    decoder.thread_count = 1
    sizes: dict[str, list[int]] = {"jpeg": [], "h264": []}
    near: dict[str, list[float]] = {"jpeg to true": [], "h264 to true": [], "h264 to jpeg": []}
    took: dict[str, list[float]] = {"coding": [], "decoding": []}
    for number, true in enumerate(of.pictures):
        jpeg = encode_colour(true)
        begin = time.thread_time()
        coded = encoder.encode(jpeg, number * PERIOD_NS)
        took["coding"].append(time.thread_time() - begin)
        begin = time.thread_time()
        (frame,) = decoder.decode(av.Packet(coded.data))
        shown = frame.to_ndarray(format="rgb24")
        took["decoding"].append(time.thread_time() - begin)
        sizes["jpeg"].append(len(jpeg.data))
        sizes["h264"].append(len(coded.data))
        near["jpeg to true"].append(decibels(decode_colour(jpeg), true))
        near["h264 to true"].append(decibels(shown, true))
        near["h264 to jpeg"].append(decibels(shown, decode_colour(jpeg)))
    jpeg_kb, coded_kb = (statistics.fmean(of_codec) / 1e3 for of_codec in sizes.values())
    nearness = [f"{name} {statistics.fmean(all_of):.1f} dB" for name, all_of in near.items()]
    times = [f"{name} {1e3 * statistics.fmean(all_of):.1f} ms" for name, all_of in took.items()]
    print(
        f"{of.name}: {jpeg_kb:.1f} kB as JPEG, {coded_kb:.1f} kB as H.264, "
        f"{jpeg_kb / coded_kb:.1f} times smaller; {', '.join(nearness)} "
        f"(least {min(near['h264 to jpeg']):.1f}); {', '.join(times)}",
        flush=True,
    )


def record(colour: str, frames: Sequence[RgbdFrame], seconds: float) -> None:
    """Let a recorder record a camera, and print what it took."""
    with tempfile.TemporaryDirectory() as folder:
        rig = RunningRig(Path(folder))
        try:
            recorder = start_recorder(rig, f'colour = "{colour}"')
            with Wire.at(rig.meeting) as wire:
                info, out = wire.publisher(INFO, "front"), wire.publisher(RGBD, "front")
                lens = {"width": 640, "height": 480, "fx": 525, "fy": 525, "cx": 320, "cy": 240}
                info.put(CameraInfo(sequence=0, time_ns=time.time_ns(), **lens))
                eventually("the recorder", out.wanted)
                process = psutil.Process(recorder.popen.pid)
                sent, begin = 0, time.monotonic()
                cpu = process.cpu_times()
                while time.monotonic() - begin < seconds:
                    place = sent % (2 * len(frames))
                    shown = frames[min(place, 2 * len(frames) - 1 - place)]
                    stamp = {"sequence": sent, "time_ns": time.time_ns()}
                    out.put(RgbdFrame(**stamp, colour=shown.colour, depth=shown.depth))
                    sent += 1
                    time.sleep(max(0.0, begin + sent / 30 - time.monotonic()))
                passed, after = time.monotonic() - begin, process.cpu_times()
                cores = (after.user + after.system - cpu.user - cpu.system) / passed
                counts = rig.health("disk")["recording"]["colour"]
                never_came = rig.counted("disk", RGBD_KEY, "lost")
                rss = process.memory_info().rss / 2**20
                time.sleep(0.5)
            assert recorder.stop() == 0
            (path,) = recordings(rig)
            size_kb, lost = path.stat().st_size / sent / 1e3, sent - len(numbers([path]))
            print(
                f"recorded as {colour}: {cores:.3f} cores, {rss:.0f} MiB, {size_kb:.1f} kB a frame "
                f"with depth, {sent} frames sent, {lost} not recorded, of which {never_came} never "
                f"came; {counts}",
                flush=True,
            )
            print_seeks(path)
        finally:
            rig.close()


def print_seeks(path: Path) -> None:
    """Print what reading one picture anywhere takes, and each of all in turn."""
    with open_index(path) as index:
        messages = index.messages(RGBD.stream, "front")
        seeks = []
        for number in np.random.default_rng(0).integers(0, len(messages), 40).tolist():
            begin = time.perf_counter()
            decode_colour(messages[number].frame().colour)
            seeks.append(time.perf_counter() - begin)
        begin = time.perf_counter()
        for one in messages:
            decode_colour(one.frame().colour)
        each = (time.perf_counter() - begin) / len(messages)
    print(
        f"a picture anywhere: median {1e3 * statistics.median(seeks):.0f} ms, most "
        f"{1e3 * max(seeks):.0f} ms; each of all in turn: {1e3 * each:.1f} ms"
    )


def main() -> None:
    """Run it all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=30.0)
    chosen = parser.parse_args()
    for interaction in ("drinkFromMug", "hitGolfBall", "pourCream"):
        print_quality(simulated(interaction))
    for one in real():
        print_quality(one)
    simulation = simulate("drinkFromMug", participant=5, seed=0, frames=FRAMES)
    seen = [simulation.render(frame) for frame in range(FRAMES)]
    pixels = [(encode_colour(one.colour), encode_depth(one.depth)) for one in seen]
    frames = [
        RgbdFrame(sequence=0, time_ns=0, colour=colour, depth=depth) for colour, depth in pixels
    ]
    for codec in ("published", "h264"):
        record(codec, frames, chosen.seconds)


if __name__ == "__main__":
    main()
