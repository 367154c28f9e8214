"""A rig that is nothing but numbers: ``publisher.py …`` publishes test messages."""

import argparse
import os
import signal
import sys
import threading
import time

from coded_rig import picture
from inhand_runtime.pixels import encode_colour
from inhand_runtime.session import Publisher, open_session
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.keys import Site
from inhand_schemas.messages import CameraInfo, ColourImage, ObjectPose, RgbdFrame
from inhand_schemas.topics import INFO, POSE, RELIABLE, RGBD, Topic

CAMERA = "front"
OBJECT = "mug"
WIDTH, HEIGHT = 640, 480

# Waiting for the readers, so that a busy machine slows a test and loses it nothing.
FRAMES = Topic(RGBD.stream, RgbdFrame, RELIABLE)
POSES = Topic(POSE.stream, ObjectPose, RELIABLE)


def main() -> int:
    """Publish calibration at once, then frames and poses while somebody wants them."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--meeting", required=True)
    parser.add_argument("--frames", type=int, default=1 << 62)
    parser.add_argument("--rate", type=float, default=30.0)
    parser.add_argument("--frame-bytes", type=int, default=1000)
    parser.add_argument("--newer", action="store_true", help="publish version 2 as well")
    parser.add_argument("--skip", type=int, action="append", default=[])
    parser.add_argument("--pictures", action="store_true", help="frames show something")
    chosen = parser.parse_args()
    stop = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: stop.set())
    pixels = [os.urandom(chosen.frame_bytes)]
    if chosen.pictures:
        pixels = [encode_colour(picture(number, WIDTH, HEIGHT)).data for number in range(32)]
    site = Site()
    with open_session(ZenohSettings(meeting=chosen.meeting)) as session:

        def ignore(_key: str) -> None: ...

        info = Publisher(session, INFO, INFO.key(site, CAMERA), ignore)
        frames = Publisher(session, FRAMES, FRAMES.key(site, CAMERA), ignore)
        poses = Publisher(session, POSES, POSES.key(site, OBJECT), ignore)
        info.put(
            CameraInfo(
                sequence=0,
                time_ns=time.time_ns(),
                width=WIDTH,
                height=HEIGHT,
                fx=500.0,
                fy=500.0,
                cx=320.0,
                cy=240.0,
            )
        )
        print("ready", flush=True)
        while not (frames.wanted() and poses.wanted()) and not stop.wait(0.02):
            pass
        start = time.monotonic()
        published = 0
        for number in range(chosen.frames):
            if stop.wait(max(0.0, start + number / chosen.rate - time.monotonic())):
                break
            if number in chosen.skip:
                continue
            stamp = {"sequence": number, "time_ns": time.time_ns()}
            data = pixels[number % len(pixels)]
            frames.put(RgbdFrame(**stamp, colour=ColourImage("jpeg", WIDTH, HEIGHT, data)))
            poses.put(
                ObjectPose(**stamp, object=OBJECT, camera=CAMERA, state="lost", confidence=0.0)
            )
            if chosen.newer:
                session.put(POSE.key(site, OBJECT).replace("@v1", "@v2"), b"\x80")
                encoding = POSE.encoding.replace(".v1", ".v2")
                session.put(POSE.key(site, "newer"), b"\x80", encoding=encoding)
            if published % 30 == 0:
                info.repeat()  # as daemons do each second
            published += 1
        print(f"published {published}", flush=True)
        stop.wait()
    return 0


if __name__ == "__main__":
    sys.exit(main())
