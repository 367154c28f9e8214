"""The sphere about an object: where its centre is, and how far it reaches."""

from dataclasses import dataclass

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.kernels.sphere_way import farthest_way
from inhand_tracker.geometry.placement import Placement
from inhand_tracker.geometry.pose_gaussian import PoseGaussian


@dataclass(frozen=True)
class BoundingSphere:
    """A sphere that holds an object: ``centre`` (3,) in its frame, ``radius`` in metres.

    Poses are those of a point of the object, its ``pivot`` (3,), the sphere's centre where none is
    given.
    """

    centre: Array
    radius: float
    pivot: Array | None = None

    @property
    def _pivot(self) -> Array:
        return self.centre if self.pivot is None else self.pivot

    def origins(self, pivots: Array, orientations: Array) -> Array:
        """Give the translations (P, 3) of poses by their pivots (P, 3) and rotations (P, 4)."""
        return pivots - rotations.rotate(orientations, self._pivot)

    def middles(self, pivots: Array, orientations: Array) -> Array:
        """Give the spheres' centres (P, 3) of poses by their pivots (P, 3) and rotations (P, 4)."""
        return pivots + rotations.rotate(orientations, self.centre - self._pivot)

    def way(
        self,
        earlier: PoseGaussian,
        now: PoseGaussian,
        camera: Intrinsics,
        view_from_reference: Placement | None = None,
    ) -> float:
        """Pixels that the sphere goes between two poses' means: the farthest that one of six points
        of it does, opposite in pairs. 0 where none is before the camera, which stands at
        ``view_from_reference``, or where poses are of."""
        places = [
            (self.middles(pose.centre, pose.rotation), pose.rotation) for pose in (earlier, now)
        ]
        if view_from_reference is not None:
            places = [view_from_reference.poses(*place) for place in places]
        return float(farthest_way(*places[0], *places[1], self.radius, camera.lens))

    def arm(self, rotation: Array) -> Array:
        """Give the way (3,) from the object's origin to the pivot, as a rotation (4,) turns it."""
        return rotations.rotate(rotation, self._pivot)
