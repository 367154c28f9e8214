"""The sphere about an object's marked points: where its centre is, and how far it reaches."""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.pose_gaussian import PoseGaussian


@dataclass(frozen=True)
class BoundingSphere:
    """``centre`` (3,) in the object's frame, and the ``radius`` about it that holds the object."""

    centre: Array
    radius: float

    def origins(self, centres: Array, orientations: Array) -> Array:
        """The translations (P, 3) of poses whose centres are known."""
        return centres - rotations.rotate(orientations, self.centre)

    def ends(self, pose: PoseGaussian) -> Array:
        """Six points (6, 3) of the sphere, opposite in pairs."""
        axes = self.radius * np.concatenate((np.eye(3), -np.eye(3)))
        return pose.centre + rotations.rotate(pose.rotation, axes)

    def arm(self, rotation: Array) -> Array:
        """From the object's origin to its centre, (3,), turned as a pose (4,) turns it."""
        return rotations.rotate(rotation, self.centre)
