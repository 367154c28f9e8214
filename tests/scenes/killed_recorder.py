"""Kills a recorder at random moments, and says how much of what came is missing afterwards.

``python tests/scenes/killed_recorder.py --times 10``: frames of 164 kB and poses come 30 times a
second, or with ``--colour h264`` pictures that are coded. After each kill what is left is recovered
and verified; missing is the time from the last message that was saved to the kill, less the time
between two messages.
"""

import argparse
import json
import random
import signal
import sys
import tempfile
import time
from pathlib import Path

from inhand_recorder.recovery import recover_recording
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_recording
from running_rig import RunningRig, eventually

FRAME_BYTES = 164_000
PERIOD_S = 1.0 / 30.0
MOST_MISSING_S = 0.25


def missing_after_kills(folder: Path, times: int, seed: int, colour: str) -> list[float]:
    """Return the seconds that are missing after each kill; raises AssertionError for a message that
    is damaged, or missing before the end."""
    draw, rig, missing = random.Random(seed), RunningRig(folder), []
    try:
        rig.configure(f'[recorder.disk]\nfolder = "{folder}/disk"\ncolour = "{colour}"')
        pictures = ["--frame-bytes", str(FRAME_BYTES)] if colour == "published" else ["--pictures"]
        rig.publisher(*pictures)
        for number in range(times):
            missing.append(_missing_after_kill(rig, folder, number, draw))
    finally:
        rig.close()
    return missing


def _missing_after_kill(rig: RunningRig, folder: Path, number: int, draw: random.Random) -> float:
    recorder = rig.inhand("recorder", "--config", rig.config)
    recorder.said("is up")
    (part,) = eventually("a file", lambda: list((folder / "disk").glob("*.part")))
    time.sleep(2.0 + draw.random())
    killed_ns = time.time_ns()
    recorder.stop(signal.SIGKILL)
    saved = folder / f"saved_{number}.mcap"
    recover_recording(part, saved)
    part.unlink()
    assert [line for line in verify_recording(saved) if "no camera info" not in line] == []
    frames = list(read_recording(saved, streams=["rgbd"]))
    numbers = [frame.sequence for frame in frames]
    assert numbers == list(range(numbers[0], numbers[-1] + 1)), "frames are missing in the middle"
    assert all(frame.message() for frame in frames[-40:]), "a frame cannot be decoded"
    return max((killed_ns - frames[-1].received_ns) / 1e9 - PERIOD_S, 0.0)


def main() -> int:
    """Exit code 0 where no more than a quarter of a second is missing."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--times", type=int, default=10)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--colour", choices=("published", "h264"), default="published")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="inhand_killed_") as name:
        missing = missing_after_kills(Path(name), arguments.times, arguments.seed, arguments.colour)
    print(json.dumps({"missing_s": [round(one, 3) for one in missing], "most": max(missing)}))
    return int(max(missing) > MOST_MISSING_S)


if __name__ == "__main__":
    sys.exit(main())
