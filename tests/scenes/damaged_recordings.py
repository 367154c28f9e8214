"""Damages copies of a recording at random, and sees that each is judged, and nothing false saved.

``python tests/scenes/damaged_recordings.py --files 1000``: so many copies are cut off, and as many
are damaged in other ways (bits, runs of bytes, lengths, parts that are gone, twice there or
exchanged). Of each, ``verify`` and ``recover`` have to end within seconds, with a verdict and in
bounded memory, and no message may be saved that the recording did not hold, unless it is called
unchecked, since its checksum was hit too.
"""

import argparse
import json
import random
import resource
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from inhand_recorder.faults import UNCHECKED
from inhand_recorder.recovery import recover_recording
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import RecordingError
from recordings import contents, write_recording

MOST_S = 20.0
"""Seconds in which a file is to be judged, on a busy machine."""
MOST_MORE_BYTES = 1 << 30
"""Address space that judging may take beyond what the process has."""
ODD_LENGTHS = (0, 1, 0xFF, 0xFFFF, 2**31, 2**32 - 1, 2**40, 2**63, 2**64 - 1)


def damage(folder: Path, files: int, seed: int) -> dict[str, int]:
    """Return how many files had which verdict; raises AssertionError for a false one."""
    draw = random.Random(seed)
    whole = write_recording(folder / "whole.mcap", frames=60)
    data, known = whole.read_bytes(), set(contents(whole))
    verdicts: Counter[str] = Counter()
    with _bounded_memory():
        for number in range(2 * files):
            way = "cut" if number < files else draw.choice(list(WAYS))
            changed = _cut(draw, data) if way == "cut" else WAYS[way](draw, data)
            path = folder / "damaged.mcap"
            path.write_bytes(changed)
            try:
                with _in_time():
                    verdicts[_judged(path, folder / "saved.mcap", known)] += 1
            except BaseException:
                print(f"file {number} of seed {seed}, {way}: kept as {path}", file=sys.stderr)
                raise
    return dict(verdicts)


def _judged(path: Path, saved: Path, known: set[tuple[str, bytes, int, int, int]]) -> str:
    saved.unlink(missing_ok=True)
    try:
        told = verify_recording(path)
    except RecordingError:
        told = ["is none"]
    try:
        report = recover_recording(path, saved)
    except RecordingError:
        assert told, "what cannot be recovered was called whole"
        return "nothing to recover"
    found = set(contents(saved))
    for key, *_ in found - known:
        # Only where the checksums were hit as well, and then it says so.
        assert any(key in line and UNCHECKED in line for line in report.faults), "saved, and false"
    if known <= found:
        return "all recovered"
    assert told, "messages are lost, and the file was called whole"
    return "a part recovered"


@contextmanager
def _bounded_memory() -> Iterator[None]:
    limits = resource.getrlimit(resource.RLIMIT_AS)
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    most = pages * resource.getpagesize() + MOST_MORE_BYTES
    resource.setrlimit(resource.RLIMIT_AS, (most, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, limits)


@contextmanager
def _in_time() -> Iterator[None]:
    def late(_number: int, _frame: FrameType | None) -> None:
        raise TimeoutError(f"no verdict within {MOST_S:.0f} s")

    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, MOST_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def _cut(draw: random.Random, data: bytes) -> bytes:
    return data[: draw.randrange(len(data))]


def _bits(draw: random.Random, data: bytes) -> bytes:
    changed = bytearray(data)
    for _ in range(draw.choice((1, 3, 50))):
        changed[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
    return bytes(changed)


def _run(draw: random.Random, data: bytes) -> bytes:
    start, size = _part(draw, data)
    filling = bytes(size) if draw.random() < 0.5 else draw.randbytes(size)
    return data[:start] + filling + data[start + size :]


def _length(draw: random.Random, data: bytes) -> bytes:
    start = draw.randrange(len(data) - 8)
    size = draw.choice((4, 8))
    value = draw.choice(ODD_LENGTHS) % 256**size
    return data[:start] + value.to_bytes(size, "little") + data[start + size :]


def _gone(draw: random.Random, data: bytes) -> bytes:
    start, size = _part(draw, data)
    return data[:start] + data[start + size :]


def _twice(draw: random.Random, data: bytes) -> bytes:
    start, size = _part(draw, data)
    return data[: start + size] + data[start:]


def _exchanged(draw: random.Random, data: bytes) -> bytes:
    first, size = _part(draw, data)
    second = draw.randrange(len(data) - size)
    changed = bytearray(data)
    changed[second : second + size] = data[first : first + size]
    return bytes(changed)


def _part(draw: random.Random, data: bytes) -> tuple[int, int]:
    size = draw.choice((1, 8, 100, 5_000))
    return draw.randrange(len(data) - size), size


WAYS: dict[str, Callable[[random.Random, bytes], bytes]] = {
    "bits": _bits,
    "run": _run,
    "length": _length,
    "gone": _gone,
    "twice": _twice,
    "exchanged": _exchanged,
}
"""Ways to damage a file, beside cutting it off."""


def main() -> int:
    """Exit code 0 where all were judged rightly."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--files", type=int, default=1000, help="number of files of each kind")
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    begin = time.monotonic()
    folder = Path(tempfile.mkdtemp(prefix="inhand_damaged_"))
    verdicts = damage(folder, arguments.files, arguments.seed)
    print(json.dumps({**verdicts, "seconds": round(time.monotonic() - begin, 1)}))
    for path in folder.iterdir():
        path.unlink()
    folder.rmdir()
    return 0


if __name__ == "__main__":
    sys.exit(main())
