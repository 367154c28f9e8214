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
from inhand_tracker.geometry.arrays import Array, Indices

from inhand_lab.datasets.frame_pixels import pixels_of
from inhand_lab.datasets.recorded_frames import RecordedFrame
from inhand_lab.recognition import adaptive_trackers
from inhand_lab.recognition.parameters import DEFAULT_RECOGNITION_EVALUATION


@dataclass(frozen=True)
class Environments:
    """Pythons that have OpenCV: ours, and, unless None, one with its build of ``contrib``."""

    contrib: Path | None = None

    def of(self) -> dict[str, str]:
        """Return the Python that runs each adaptive tracker that can be had."""
        own = sys.executable if self.contrib is None else str(self.contrib)
        names = adaptive_trackers.available() if self.contrib is None else _ask(own)
        return dict.fromkeys(names, own)


def follow_adaptively(
    path: Path, frames: Sequence[RecordedFrame], boxes: Array, pythons: dict[str, str]
) -> dict[str, Array]:
    """Follow an object by each adaptive tracker; return boxes (T, 4), left, top, right and bottom.

    Each starts at the first finite one of the true ``boxes`` (T, 4); before it they are NaN. Raises
    InhandError or RecordingError.
    """
    if not pythons:
        return {}
    finite = np.flatnonzero(np.isfinite(boxes).all(axis=1))
    shown, images = _images_from(path, frames, int(finite[0]))
    first = _first_box(boxes[shown[0]])
    followed = {}
    for python in dict.fromkeys(pythons.values()):
        names = [name for name, where in pythons.items() if where == python]
        for name, found in _run(python, images, first, names).items():
            x, y, width, height = np.array(found).T
            series = np.full((len(frames), 4), np.nan)
            series[shown] = np.column_stack((x, y, x + width, y + height))
            followed[name] = series
    return followed


def _images_from(
    path: Path, frames: Sequence[RecordedFrame], first: int
) -> tuple[Indices, list[bytes]]:
    """Read the JPEG images from a frame on; return the numbers (S,) of their frames, and them."""
    images = {
        number: pixels.colour.data
        for number, pixels in pixels_of(path, frames)
        if number >= first and pixels.colour is not None and pixels.colour.codec == "jpeg"
    }
    return np.array(list(images), np.int64), list(images.values())


def _first_box(box: Array) -> list[int]:
    """Return left, top, width and height of a box (4,), as adaptive trackers take them."""
    left, top, right, bottom = box
    least = DEFAULT_RECOGNITION_EVALUATION.least_box_pixels
    sides = (max(left, 0.0), max(top, 0.0), max(right - left, least), max(bottom - top, least))
    return [round(side) for side in sides]


def _run(
    python: str, images: Sequence[bytes], box: list[int], trackers: list[str]
) -> dict[str, list[list[float]]]:
    """Run trackers by a Python; return the boxes of each in every image."""
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
    """Return the names of the adaptive trackers that a Python's OpenCV has."""
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
    """Run a command; return what it prints. Raises InhandError."""
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
