"""Where one frame of reference is in another: a rigid transform, for points, poses and itself."""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array


@dataclass(frozen=True)
class Placement:
    """A rigid transform, named ``a_from_b``: ``translation`` (3,) in metres, ``rotation`` (4,)."""

    translation: Array
    rotation: Array

    def points(self, points: Array) -> Array:
        """Take points (..., 3) of b to a."""
        return rotations.rotate(self.rotation, points) + self.translation

    def poses(self, translations: Array, orientations: Array) -> tuple[Array, Array]:
        """Take poses (..., 3) and (..., 4) of b to a."""
        return self.points(translations), rotations.multiply(self.rotation, orientations)

    def inverse(self) -> "Placement":
        """Return ``b_from_a``."""
        rotation = rotations.conjugate(self.rotation)
        return Placement(-rotations.rotate(rotation, self.translation), rotation)

    def __matmul__(self, other: "Placement") -> "Placement":
        """Chain ``a_from_b @ b_from_c`` to ``a_from_c``."""
        return Placement(*self.poses(other.translation, other.rotation))


HERE = Placement(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]))
"""The placement of a frame in itself."""
