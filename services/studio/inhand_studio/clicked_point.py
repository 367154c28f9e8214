"""Where a click in the scene meets an object."""

import numpy as np
from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.keyframes import LabellingError
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import ObjectShape


def point_on(shape: ObjectShape, pose: Pose, origin: Array, direction: Array) -> Array:
    """Return the point (3,) of an object's surface, in its frame, that a ray meets first.

    The ray, (3,) and (3,), and the pose are in the frame of the scene. Raises LabellingError where
    it misses the object.
    """
    back = rotations.conjugate(pose[1])
    start = rotations.rotate(back, origin - pose[0])
    along = rotations.rotate(back, direction)
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
