"""A flat wall before a simulated camera, and the depth that is measured of it."""

import numpy as np
from inhand_lab.geometry.canvas import Canvas
from inhand_lab.sensing.cameras import Camera
from inhand_lab.sensing.render import ROOM
from inhand_lab.sensing.sensor import FrameConditions, sense
from inhand_tracker.geometry.arrays import Array


def wall(distance: float, camera: Camera) -> Canvas:
    """Grey, with enough of a pattern to be matched."""
    canvas = Canvas.blank(camera.intrinsics)
    canvas.inverse_depth[:] = 1.0 / distance
    canvas.labels[:] = ROOM
    canvas.colour[:] = 118 + 4 * (np.arange(camera.intrinsics.width) % 2)[:, None]
    return canvas


def depth_of(canvas: Canvas, camera: Camera, seed: int = 0, unseen: int = 0) -> Array:
    random = np.random.default_rng(seed)
    return sense(canvas, camera, random, FrameConditions(unseen=unseen))[1].astype(float)
