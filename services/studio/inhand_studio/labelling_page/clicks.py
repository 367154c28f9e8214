"""A pose from clicks: on the object and on the image by turns, or once where the object is."""

from dataclasses import dataclass

import numpy as np
from inhand_lab.labelling.keyframes import LabellingError
from inhand_lab.labelling.pose_start import FEWEST, PickedPoint
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics


@dataclass(frozen=True)
class Picking:
    """What was clicked on so far: whole pairs, and a ``point`` (3,) of the object, in its frame,
    whose place in the image is next; None where a point of the object is next."""

    pairs: tuple[PickedPoint, ...] = ()
    point: Array | None = None

    @property
    def done(self) -> bool:
        """Whether the pairs fix a pose."""
        return len(self.pairs) == FEWEST

    @property
    def next_click(self) -> str:
        """What is to be clicked on next."""
        number = len(self.pairs) + 1
        if self.point is None:
            return f"Click on point {number} of {FEWEST} of the object. Escape ends this."
        return f"Click on where point {number} is seen in the image."

    def with_point(self, point: Array) -> "Picking":
        """Note a point of the object."""
        return Picking(self.pairs, point)

    def with_pixel(self, pixel: Array) -> "Picking":
        """Note where the point is seen in the image."""
        if self.point is None:
            raise LabellingError("click on a point of the object first")
        return Picking((*self.pairs, PickedPoint(pixel, self.point)))


def pixel_along(camera: Intrinsics, origin: Array, direction: Array) -> Array:
    """Return the pixel (2,) of a camera, in whose frame a ray is that starts at it.

    Raises LabellingError where the ray starts elsewhere.
    """
    if np.linalg.norm(origin) > 1e-3 or direction[2] <= 0.0:
        raise LabellingError("look through the camera, at colours or depths, to click on the image")
    return np.asarray(camera.project(direction / direction[2]))
