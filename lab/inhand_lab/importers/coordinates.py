"""Coordinate systems and units that other programs write joints in."""

from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.datasets.units import UNITS_M
from inhand_lab.importers.body_checks import Mends

AXES = {
    "IMAGE": ("x", "y", "z"),
    "LEFT_HANDED_Y_UP": ("x", "-y", "z"),
    "RIGHT_HANDED_Y_UP": ("x", "-y", "-z"),
    "RIGHT_HANDED_Z_UP": ("x", "-z", "y"),
    "LEFT_HANDED_Z_UP": ("y", "-z", "x"),
    "RIGHT_HANDED_Z_UP_X_FWD": ("-y", "-z", "x"),
}
"""What lies to the right, down and forwards in the image in each of ZED's coordinate systems."""

UNITS = {"metres": 1.0} | UNITS_M
"""Units of length by name, in metres."""


@dataclass(frozen=True)
class Coordinates:
    """A coordinate system, by name, at the camera, and a unit of length, by name."""

    system: str
    unit: str = "metres"

    def to_camera(self, places: Array) -> Array:
        """Return places (..., 3) in metres in OpenCV's camera frame."""
        columns = ["xyz".index(axis[-1]) for axis in AXES[self.system]]
        signs = np.array([-1.0 if axis[0] == "-" else 1.0 for axis in AXES[self.system]])
        with np.errstate(over="ignore"):
            return UNITS[self.unit] * signs * places[..., columns]

    def mends(self) -> Mends:
        """What mends bodies that are in other coordinates."""
        axes = f"axes are not those of {self.system}: give --coordinate-system"
        return Mends("give --unit {unit}", axes, UNITS[self.unit])
