"""Makes a recording of tens of gigabytes, and sees that it is read in bounded memory.

``python tests/scenes/large_recording.py --gigabytes 50``: its pictures are black, and take no room
on disks that leave zeros out. It is verified, looked into and read here and there; memory of the
process (that no file holds as well) may grow by 500 MB at the most.
"""

import argparse
import json
import os
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from inhand_recorder.inspection import inspect_recording
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import RecordingWriter
from inhand_runtime.recording.message_index import open_index
from inhand_runtime.recording.part_file import PartFile
from inhand_schemas.messages import ColourImage, RgbdFrame
from inhand_schemas.topics import RGBD
from recordings import FRAME_NS, RGBD_KEY, START_NS

BLOCK = bytes(1 << 16)
PICTURE = bytes(1 << 20)
MOST_MORE_MB = 500.0
READS = 1000


def write_large(path: Path, size: int) -> int:
    """Write a recording of that many bytes, and return its number of frames."""
    frames = 0
    with _zeros_left_out(), RecordingWriter(path) as writer:
        while writer.bytes_written < size:
            time_ns = START_NS + frames * FRAME_NS
            colour = ColourImage("jpeg", 1024, 1024, PICTURE)
            payload = RGBD.encode(RgbdFrame(sequence=frames, time_ns=time_ns, colour=colour))
            writer.write(
                RGBD_KEY, payload, received_ns=time_ns, captured_ns=time_ns, sequence=frames
            )
            frames += 1
    return frames


@contextmanager
def _zeros_left_out() -> Iterator[None]:
    """Let files have holes where nothing but zeros would stand."""
    usual_write, usual_sync = PartFile.write, PartFile.sync

    def write(self: PartFile, *parts: bytes) -> None:
        data = b"".join(parts)
        for start in range(0, len(data), len(BLOCK)):
            block = data[start : start + len(BLOCK)]
            if block == BLOCK:
                self._file.seek(len(BLOCK), os.SEEK_CUR)
                self.bytes_written += len(BLOCK)
            else:
                usual_write(self, block)

    def sync(self: PartFile) -> None:
        self._file.truncate(self.bytes_written)
        usual_sync(self)

    PartFile.write, PartFile.sync = write, sync  # type: ignore[method-assign]
    try:
        yield
    finally:
        PartFile.write, PartFile.sync = usual_write, usual_sync  # type: ignore[method-assign]


def _own_mb() -> float:
    """MB of this process that no file holds as well."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(float(line.split()[1]) / 1e3 for line in lines if line.startswith("RssAnon"))


def measured(act: Callable[[], Any]) -> dict[str, float]:
    """Seconds that something takes, and by how many MB the process was larger meanwhile."""
    before, most, ended = _own_mb(), [0.0], threading.Event()

    def look() -> None:
        while not ended.wait(0.02):
            most[0] = max(most[0], _own_mb() - before)

    thread = threading.Thread(target=look)
    thread.start()
    begin = time.monotonic()
    try:
        act()
    finally:
        ended.set()
        thread.join()
    return {"seconds": round(time.monotonic() - begin, 1), "more_mb": round(most[0], 1)}


def look_into(path: Path, frames: int) -> dict[str, dict[str, float]]:
    """Verify and open a recording; raises AssertionError where it says something false."""

    def verify() -> None:
        lines = [line for line in verify_recording(path) if "have no camera info" not in line]
        assert lines == [], lines

    def inspect() -> None:
        assert inspect_recording(path).keys[0].messages == frames

    def read() -> None:
        with open_index(path) as index:
            messages = index.messages("rgbd", "kitchen")
            assert len(messages) == frames
            for number in range(0, frames, max(1, frames // READS)):
                assert messages[number].sequence == number

    return {"verify": measured(verify), "info": measured(inspect), "read": measured(read)}


def main() -> int:
    """Exit code 0 where memory was bounded."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--gigabytes", type=float, default=50.0)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="inhand_large_") as name:
        path = Path(name) / "large.mcap"
        frames = write_large(path, int(arguments.gigabytes * 1e9))
        seen = look_into(path, frames)
        taken = path.stat().st_blocks * 512 / 1e6
        print(json.dumps({"gb": path.stat().st_size / 1e9, "mb on disk": taken, **seen}, indent=2))
    return int(any(one["more_mb"] > MOST_MORE_MB for one in seen.values()))


if __name__ == "__main__":
    sys.exit(main())
