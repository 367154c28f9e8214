"""A contact sheet: every interaction a row of pictures, to see at a glance what people do."""

from collections.abc import Callable, Sequence
from pathlib import Path

import cv2
import numpy as np
from inhand_runtime.errors import InhandError
from inhand_tracker.geometry.arrays import Array, Bytes

from inhand_lab.geometry.window import Window, window_around
from inhand_lab.world.simulation import Simulation, simulate

PICTURES = 8
FIRST, LAST = 0.10, 0.90
"""The first and the last picture of a row, as shares of its time."""
WIDTH, HEIGHT = 100, 138
"""Of one picture, in pixels."""
NAME_WIDTH = 116
BESIDE_M, ABOVE_M = 0.10, 0.19
"""Shown around what moves in a row: joints are in the middle of a head."""
PAPER, INK = 255, (30, 30, 30)
JPEG_QUALITY = 60
SUFFIXES = (".png", ".jpg", ".jpeg")


def write_sheet(
    path: Path, interactions: Sequence[str], seed: int, *, on_progress: Callable[[], None]
) -> None:
    """Write the sheet as PNG or JPEG, each row another participant of the seed.

    ``on_progress`` is called once a row. Raises InhandError.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise InhandError(f"{path} is no picture's name: let it end in {' or '.join(SUFFIXES)}")
    rows = []
    for participant, interaction in enumerate(interactions):
        rows.append(_row(simulate(interaction, participant, seed)))
        on_progress()
    sheet = cv2.cvtColor(np.concatenate(rows), cv2.COLOR_RGB2BGR)
    suffix = path.suffix.lower()
    options = [] if suffix == ".png" else [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY]
    _, data = cv2.imencode(suffix, sheet, options)
    try:
        path.write_bytes(data.tobytes())
    except OSError as error:
        raise InhandError(f"cannot write {path}: {error.strerror}") from error


def _row(simulation: Simulation) -> Bytes:
    shares = np.linspace(FIRST, LAST, PICTURES)
    frames = [int(frame) for frame in np.rint(shares * (simulation.frames - 1))]
    points = np.concatenate([_points(simulation, frame) for frame in frames])
    window = window_around(simulation.intrinsics, points)
    pictures = [_picture(simulation.render(frame).colour, window) for frame in frames]
    return np.concatenate([_name(simulation.interaction), *pictures], axis=1)


def _points(simulation: Simulation, frame: int) -> Array:
    """Points (N, 3) in the camera's frame around the person and the object."""
    pose = simulation.camera_from_object[frame]
    thing = simulation.object_model.vertices @ pose.rotation.T + pose.translation
    shown = np.concatenate([simulation.true_joints_in_camera[frame], thing])
    upper_left, lower_right = (-BESIDE_M, -ABOVE_M, 0.0), (BESIDE_M, BESIDE_M, 0.0)
    return np.concatenate([shown + upper_left, shown + lower_right])


def _picture(colour: Bytes, window: Window) -> Bytes:
    """What is in the window and beside it, as large as one picture allows, on paper."""
    rows, columns = window.rows, window.columns
    missing = WIDTH * (rows.stop - rows.start) // HEIGHT - (columns.stop - columns.start)
    aside = max(missing // 2, 0)
    seen = colour[rows, max(columns.start - aside, 0) : columns.stop + aside]
    height, width = seen.shape[:2]
    scale = min(WIDTH / width, HEIGHT / height)
    size = min(round(scale * width), WIDTH), min(round(scale * height), HEIGHT)
    small = cv2.resize(seen, size, interpolation=cv2.INTER_AREA)
    picture = np.full((HEIGHT, WIDTH, 3), PAPER, np.uint8)
    left, top = (WIDTH - size[0]) // 2, (HEIGHT - size[1]) // 2
    picture[top : top + size[1], left : left + size[0]] = small
    return picture


def _name(interaction: str) -> Bytes:
    label = np.full((HEIGHT, NAME_WIDTH, 3), PAPER, np.uint8)
    place = (6, HEIGHT // 2)
    cv2.putText(
        label, interaction, place, cv2.FONT_HERSHEY_SIMPLEX, 0.45, INK, 1, lineType=cv2.LINE_AA
    )
    return label
