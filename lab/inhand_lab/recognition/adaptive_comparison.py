"""Runs OpenCV's adaptive trackers on a recording, in the environments that have them."""

import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_runtime.errors import InhandError
from inhand_tracker.geometry.arrays import Array

from inhand_lab.datasets.recorded_frames import RecordedFrame, iterate_pixels
from inhand_lab.recognition import adaptive_trackers

SMALLEST = 8
"""Pixels: a smaller first box is widened, because some trackers refuse one."""


@dataclass(frozen=True)
class Environments:
    """``contrib`` is a Python whose OpenCV is the contrib build; None where there is none."""

    contrib: Path | None = None

    def of(self) -> dict[str, str]:
        """The Python that runs each tracker that can be had."""
        own = sys.executable if self.contrib is None else str(self.contrib)
        names = adaptive_trackers.available() if self.contrib is None else _ask(own)
        return dict.fromkeys(names, own)


def follow_adaptively(
    path: Path, frames: Sequence[RecordedFrame], boxes: Array, pythons: dict[str, str]
) -> dict[str, Array]:
    """The boxes (T, 4), left, top, right, bottom, that each adaptive tracker follows.

    Each starts at the first known one of the true ``boxes`` (T, 4); before it they are NaN. Raises
    InhandError or RecordingError.
    """
    known = np.flatnonzero(np.isfinite(boxes).all(axis=1))
    images = {
        pixels.time_ns: pixels.colour.data
        for pixels in iterate_pixels(path)
        if pixels.colour is not None and pixels.colour.codec == "jpeg"
    }
    seen = [i for i in range(known[0], len(frames)) if frames[i].time_ns in images]
    left, top, right, bottom = boxes[seen[0]]
    width, height = max(right - left, SMALLEST), max(bottom - top, SMALLEST)
    first = [round(value) for value in (max(left, 0.0), max(top, 0.0), width, height)]
    shown = [images[frames[i].time_ns] for i in seen]
    followed = {}
    for python in dict.fromkeys(pythons.values()):
        wanted = [name for name, where in pythons.items() if where == python]
        for name, found in _run(python, shown, first, wanted).items():
            series = np.full((len(frames), 4), np.nan)
            x, y, wide, high = np.array(found).T
            series[seen] = np.column_stack((x, y, x + wide, y + high))
            followed[name] = series
    return followed


def _run(
    python: str, images: Sequence[bytes], box: list[int], trackers: list[str]
) -> dict[str, list[list[float]]]:
    with tempfile.TemporaryDirectory() as folder:
        data, job, result = (Path(folder) / name for name in ("frames", "job.json", "result.json"))
        data.write_bytes(b"".join(images))
        ends = np.cumsum([len(image) for image in images]).tolist()
        job.write_text(
            json.dumps({"frames": str(data), "ends": ends, "box": box, "trackers": trackers}),
            encoding="utf-8",
        )
        _call([python, adaptive_trackers.__file__, str(job), str(result)])
        boxes: dict[str, list[list[float]]] = json.loads(result.read_text(encoding="utf-8"))
        return boxes


def _ask(python: str) -> list[str]:
    folder = str(Path(adaptive_trackers.__file__).parent)
    text = _call(
        [
            python,
            "-c",
            f"import sys; sys.path.insert(0, {folder!r}); "
            "import adaptive_trackers; print(*adaptive_trackers.available())",
        ]
    )
    return text.split()


def _call(command: list[str]) -> str:
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    except OSError as error:
        raise InhandError(
            f"cannot run {command[0]}: {error.strerror}; `make contrib` makes an environment"
        ) from None
    except subprocess.CalledProcessError as error:
        last = (error.stderr.strip().splitlines() or ["it says nothing"])[-1]
        raise InhandError(f"the adaptive trackers of {command[0]} failed: {last}") from None
    return done.stdout
