"""What a ring of 30 s costs at 640 × 480: ``python tests/scenes/ring_cost.py``.

Frames of 177 kB come at 30 Hz; after 40 s a snapshot is asked for. Says the recorder's memory
before the ring filled and after, and whether the clip and the recording have each frame.
"""

import tempfile
import time
from pathlib import Path

from running_recorder import numbers, recordings, start_recorder
from running_rig import RunningRig, eventually

FRAME_BYTES = 177_000
RING = 'ring_seconds = 30\nring_bytes = "200MiB"\nafter_seconds = 5'


def missing(frames: list[int]) -> int:
    """How many numbers are missing between the first and the last."""
    return frames[-1] - frames[0] + 1 - len(frames)


def main() -> None:
    """Run it, and print what it showed."""
    with tempfile.TemporaryDirectory() as folder:
        rig = RunningRig(Path(folder))
        try:
            recorder = start_recorder(rig, RING)
            before = rig.health("disk")["resident_bytes"]
            rig.publisher("--frame-bytes", str(FRAME_BYTES))
            time.sleep(40.0)
            full = rig.health("disk")
            rig.done("recorder", "snapshot", "--config", rig.config)
            eventually("a clip", lambda: recordings(rig, "clips/*.mcap"))
            after = rig.health("disk")["resident_bytes"]
            assert recorder.stop() == 0
            held = full["recording"]
            clip, recorded = numbers(recordings(rig, "clips/*.mcap")), numbers(recordings(rig))
            print(f"ring: {held['ring_seconds']:.1f} s in {held['ring_bytes'] / 2**20:.0f} MiB")
            for what, size in (("full", full["resident_bytes"]), ("after the clip", after)):
                print(f"memory, {what}: {(size - before) / 2**20:.0f} MiB more than at the start")
            print(f"clip: {len(clip)} frames, {missing(clip)} missing")
            print(f"recording: {len(recorded)} frames, {missing(recorded)} missing")
        finally:
            rig.close()


if __name__ == "__main__":
    main()
