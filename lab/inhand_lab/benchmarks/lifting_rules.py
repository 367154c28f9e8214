"""Rules that take a joint from a picture to space, beside which capture's own is measured."""

from collections.abc import Callable

import numpy as np
from inhand_capture.estimation.conventions import as_kinect
from inhand_capture.estimation.found_person import FoundPerson
from inhand_capture.estimation.kernels.depth_clusters import window_depths
from inhand_capture.estimation.lifting import DepthPicture, joint_radii
from inhand_capture.estimation.parameters import DEFAULT_LIFTING
from inhand_runtime.pinhole import Pinhole
from inhand_tracker.geometry.arrays import Array

WINDOW_PX = 3.0
"""Radius of the window whose median is taken, pixels."""

Rule = Callable[[FoundPerson, DepthPicture, Pinhole], Array]
"""Gives a network's joints (20, 3) in space, NaN where there is no depth."""


def centre_pixel(person: FoundPerson, picture: DepthPicture, lens: Pinhole) -> Array:
    """Take the depth of the joint's own pixel, and the limb's radius below it."""
    height, width = picture.depth.shape
    columns, rows = np.nan_to_num(np.round(person.pixels), nan=-1.0).astype(int).T
    inside = (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
    depths = np.full(len(columns), np.nan)
    depths[inside] = picture.unit * picture.depth[rows[inside], columns[inside]]
    return _placed(person, depths, lens)


def window_median(person: FoundPerson, picture: DepthPicture, lens: Pinhole) -> Array:
    """Take the median depth of a window about the joint's pixel, and the limb's radius below it."""
    depths = np.full(len(person.pixels), np.nan)
    for joint, (x, y) in enumerate(person.pixels):
        if np.isfinite(x):
            there = window_depths(picture.depth, picture.unit, x, y, WINDOW_PX)
            depths[joint] = np.median(there) if len(there) else np.nan
    return _placed(person, depths, lens)


RULES: dict[str, Rule] = {"centre pixel": centre_pixel, "median of a window": window_median}
"""The rules by what they are called."""


def kinect_joints(seen: Array) -> Array:
    """Return Kinect's joints (20, 3) of a network's in space."""
    states = np.where(np.isfinite(seen[:, 0]), 2, 0).astype(np.uint8)
    joints, _ = as_kinect(seen, states, DEFAULT_LIFTING)
    return joints


def _placed(person: FoundPerson, depths: Array, lens: Pinhole) -> Array:
    depths = np.where(depths > 0.0, depths + joint_radii(DEFAULT_LIFTING), np.nan)
    return np.column_stack((lens.rays(person.pixels) * depths[:, None], depths))
