"""Follows boxes through frames with OpenCV's adaptive trackers: a program by itself.

It needs OpenCV and nothing else of this project, so that it can run in another environment: CSRT
and TLD are in OpenCV's contrib build only, which cannot stand beside the headless one.

    python adaptive_trackers.py JOB.json RESULT.json

The job: ``frames`` a file of JPEG images one after the other, ``ends`` where each ends, ``box`` the
true first one (left, top, width, height), ``trackers`` names. The result: for every tracker that
this OpenCV has, the box in each frame; a tracker that lost its box keeps the last one.
"""

import json
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import cv2
import numpy as np

FACTORIES = {
    "MIL": ("TrackerMIL_create",),
    "CSRT": ("TrackerCSRT_create",),
    "TLD": ("legacy", "TrackerTLD_create"),
}


def available() -> list[str]:
    """Return the names of the trackers that this OpenCV has."""
    return [name for name in FACTORIES if _factory(name) is not None]


def _factory(name: str) -> Any:
    factory: Any = cv2
    for part in FACTORIES[name]:
        factory = getattr(factory, part, None)
    return factory


def follow_box(images: list[Any], box: list[int], name: str) -> list[list[float]]:
    """Follow a box by one tracker; return it in all images. ``box`` is that in the first."""
    cv2.setRNGSeed(0)
    tracker = _factory(name)()
    tracker.init(images[0], tuple(box))
    boxes = [[float(value) for value in box]]
    for image in images[1:]:
        success, box = tracker.update(image)
        boxes.append([float(value) for value in box] if success else boxes[-1])
    return boxes


def main(job_file: str, result_file: str) -> None:
    """Follow the boxes of a job, and write the result."""
    cv2.setNumThreads(1)
    job = json.loads(Path(job_file).read_text(encoding="utf-8"))
    data = Path(job["frames"]).read_bytes()
    images = [
        cv2.imdecode(np.frombuffer(data[start:end], np.uint8), cv2.IMREAD_COLOR)
        for start, end in pairwise([0, *job["ends"]])
    ]
    wanted = [name for name in job["trackers"] if name in available()]
    result = {name: follow_box(images, job["box"], name) for name in wanted}
    Path(result_file).write_text(json.dumps(result), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
