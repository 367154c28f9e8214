"""The sphere about an object: where its centre is, and how far it reaches."""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array


@dataclass(frozen=True)
class BoundingSphere:
    """A sphere that holds an object: ``centre`` (3,) in its frame, ``radius`` in metres."""

    centre: Array
    radius: float

    def origins(self, centres: Array, orientations: Array) -> Array:
        """Give the translations (P, 3) of poses by their spheres' centres (P, 3)."""
        return centres - rotations.rotate(orientations, self.centre)

    def ends(self, centres: Array, orientations: Array) -> Array:
        """Give six points (..., 6, 3) of the sphere, opposite in pairs, at its centres (..., 3)."""
        axes = self.radius * np.concatenate((np.eye(3), -np.eye(3)))
        return centres[..., None, :] + rotations.rotate(orientations[..., None, :], axes)

    def arm(self, rotation: Array) -> Array:
        """Give the way (3,) from the object's origin to the centre, as a rotation (4,) turns it."""
        return rotations.rotate(rotation, self.centre)
