"""Reads image files of other people."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from inhand_lab.datasets.dataset import DatasetError

Frame = TypeVar("Frame")
Pixels = TypeVar("Pixels")


def first_readable(frames: Iterable[Frame], read: Callable[[Frame], Pixels]) -> Pixels:
    """Read the first frame that can be read; raises DatasetError where there is none."""
    failure = DatasetError("there is no frame with an image")
    for number, frame in enumerate(frames):
        try:
            return read(frame)
        except DatasetError as error:
            failure = failure if number else error
    raise failure


def read_image(path: Path, flags: int) -> NDArray[Any]:
    """Read the pixels as ``cv2.imdecode`` decodes them with the flags; raises DatasetError."""
    try:
        data = np.frombuffer(path.read_bytes(), np.uint8)
    except OSError as error:
        raise DatasetError(f"cannot read {path}: {error.strerror}") from None
    image = cv2.imdecode(data, flags) if data.size else None
    if image is None:
        raise DatasetError(f"{path} is no image that can be read: fetch it again")
    return image
