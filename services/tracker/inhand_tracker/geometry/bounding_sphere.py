"""The sphere about an object: where its centre is, and how far it reaches."""

from dataclasses import dataclass

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.kernels.sphere_way import farthest_way
from inhand_tracker.geometry.pose_gaussian import PoseGaussian


@dataclass(frozen=True)
class BoundingSphere:
    """A sphere that holds an object: ``centre`` (3,) in its frame, ``radius`` in metres."""

    centre: Array
    radius: float

    def origins(self, centres: Array, orientations: Array) -> Array:
        """Give the translations (P, 3) of poses by their spheres' centres (P, 3)."""
        return centres - rotations.rotate(orientations, self.centre)

    def way(self, earlier: PoseGaussian, now: PoseGaussian, camera: Intrinsics) -> float:
        """Pixels that the sphere goes between two poses' means: the farthest that one of six points
        of it does, opposite in pairs. 0 where none is before the camera."""
        return float(
            farthest_way(
                earlier.centre, earlier.rotation, now.centre, now.rotation, self.radius, camera.lens
            )
        )

    def arm(self, rotation: Array) -> Array:
        """Give the way (3,) from the object's origin to the centre, as a rotation (4,) turns it."""
        return rotations.rotate(rotation, self.centre)
