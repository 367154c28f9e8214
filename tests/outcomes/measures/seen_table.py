"""A level camera's view of a floor with a table on it."""

import numpy as np
from inhand_outcomes.room import Room
from inhand_schemas.messages import CameraInfo
from numpy.typing import NDArray

INFO = CameraInfo(
    sequence=0, time_ns=0, width=640, height=480, fx=525.0, fy=525.0, cx=319.5, cy=239.5
)
ROOM = Room(np.array([0.0, -1.0, 0.0]), -1.2)
"""A level camera, 1.2 m above the floor."""


def table_depth() -> NDArray[np.uint16]:
    """A level camera's depth of the floor, and of a plate 0.7 m high, 1 m square, 2 m ahead."""
    v, u = np.mgrid[0:480, 0:640]
    rays = np.stack([(u - 319.5) / 525.0, (v - 239.5) / 525.0, np.ones(u.shape)], axis=-1)
    with np.errstate(divide="ignore"):
        floor, top = 1.2 / rays[..., 1], 0.5 / rays[..., 1]
    on_top = (top > 2.0) & (top < 3.0) & (np.abs(rays[..., 0] * top) < 0.5)
    depth = np.where(on_top, top, np.where((floor > 0.0) & (floor < 6.0), floor, 0.0))
    return np.rint(1000.0 * depth).astype(np.uint16)
