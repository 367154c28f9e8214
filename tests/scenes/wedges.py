"""Images of the wedge in a stranger's hand, drawn without the code under test."""

from functools import cache

import numpy as np
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from people import held, scipy_rotation, unseen_wave

FRAMES = 25
CAMERA = Intrinsics(260.0, 260.0, 159.5, 119.5, 320, 240)
RED, GREY = (200, 30, 30), (110, 110, 110)


def draw(place: np.ndarray, turn: np.ndarray) -> Image:
    """The wedge as red dots of its box before a grey wall, with its depth."""
    colour = np.full((240, 320, 3), GREY, np.uint8)
    depth = np.full((240, 320), 3.5, np.float32)
    steps = np.linspace(-0.5, 0.5, 60)
    inside = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    points = scipy_rotation(turn).apply(inside * [0.06, 0.09, 0.24]) + place
    columns, rows = np.rint(CAMERA.project(points)).astype(int).T
    shown = (columns >= 0) & (rows >= 0) & (columns < 320) & (rows < 240)
    rows, columns, nearness = rows[shown], columns[shown], points[shown, 2]
    colour[rows, columns] = RED
    np.minimum.at(depth, (rows, columns), nearness.astype(np.float32))
    return Image(None, CAMERA, depth, colour)


@cache
def images() -> tuple[Image, ...]:
    """Of somebody who is not known, holding the wedge."""
    joints = unseen_wave(FRAMES)
    return tuple(draw(*pose) for pose in zip(*held(joints, seed=7), strict=True))
