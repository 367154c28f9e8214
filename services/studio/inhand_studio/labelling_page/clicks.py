"""A pose from clicks: on the object and on the image by turns, or once where the object is."""

from dataclasses import dataclass

import numpy as np
from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.keyframes import LabellingError
from inhand_lab.labelling.pose_start import FEWEST, PickedPoint
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.shape.shape import ObjectShape

from inhand_studio.labelling_page.placing import inverse


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


def point_on(shape: ObjectShape, pose: Pose, origin: Array, direction: Array) -> Array:
    """Return the point (3,) of an object's surface, in its frame, that a ray meets first.

    The ray, (3,) and (3,), and the pose are in the camera frame. Raises LabellingError where it
    misses the object.
    """
    back = inverse(pose)
    start = back[0] + rotations.rotate(back[1], origin)
    along = rotations.rotate(back[1], direction)
    corners = shape.vertices[shape.faces]
    edges = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    across = np.cross(along, edges[1])
    determinants = (edges[0] * across).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        offset = start - corners[:, 0]
        first = (offset * across).sum(axis=1) / determinants
        turned = np.cross(offset, edges[0])
        second = turned @ along / determinants
        distances = (edges[1] * turned).sum(axis=1) / determinants
        met = (first >= 0.0) & (second >= 0.0) & (first + second <= 1.0) & (distances > 0.0)
    if not met.any():
        raise LabellingError("that is beside the object: click on it where it is drawn")
    return np.asarray(start + distances[met].min() * along)


def pixel_along(camera: Intrinsics, origin: Array, direction: Array) -> Array:
    """Return the pixel (2,) of a camera, in whose frame a ray is that starts at it.

    Raises LabellingError where the ray starts elsewhere.
    """
    if np.linalg.norm(origin) > 1e-3 or direction[2] <= 0.0:
        raise LabellingError("look through the camera, at colours or depths, to click on the image")
    return np.asarray(camera.project(direction / direction[2]))
