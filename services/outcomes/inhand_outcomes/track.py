"""One object in somebody's hands over some seconds, as arrays in the room's frame."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from inhand_schemas.joints import Joint

from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.rotations import matrices


@dataclass(frozen=True)
class Track:
    """An object's T poses with the body of who uses it, in the room: z is up, metres.

    ``times`` (T,) are seconds, rising, of an origin of the caller's. ``poses`` (T, 7) are
    room_from_object: x y z, w x y z. ``covariances`` (T, 6, 6) are of (translation, rotation vector
    applied on the left) in the room's frame. ``seen`` (T,) is where the tracker vouches for the
    pose: neither lost nor predicted, and confident enough; where it is false the pose is the last
    one that was. ``joints`` (T, 20, 3) are of the person who uses it, NaN where missing. Where
    ``floor`` is true the floor is at z = 0; else the height of the origin means nothing.
    """

    times: Array
    poses: Array
    covariances: Array
    seen: Flags
    joints: Array
    floor: bool = True

    def __len__(self) -> int:
        return len(self.times)

    def __getitem__(self, frames: slice | Flags) -> "Track":
        return Track(
            self.times[frames],
            self.poses[frames],
            self.covariances[frames],
            self.seen[frames],
            self.joints[frames],
            self.floor,
        )

    @property
    def positions(self) -> Array:
        """The object's origin (T, 3)."""
        return self.poses[:, :3]

    @cached_property
    def matrices(self) -> Array:
        """The object's rotation matrices (T, 3, 3)."""
        return matrices(self.poses[:, 3:])

    def joint(self, joint: Joint) -> Array:
        """One joint of the person (T, 3), NaN where it is missing."""
        return self.joints[:, joint]

    def points(self, points: Array) -> Array:
        """Points (3,) or (K, 3) of the object's frame, in the room: (T, 3) or (T, K, 3)."""
        turned = np.einsum("tij,...j->t...i", self.matrices, points)
        shape = (len(self), *(1,) * (points.ndim - 1), 3)
        return np.asarray(turned + self.positions.reshape(shape))

    def directions(self, direction: Array) -> Array:
        """A direction (3,) of the object's frame, in the room: (T, 3)."""
        return np.asarray(self.matrices @ direction)

    def point_deviations(self, point: Array) -> Array:
        """Standard deviation (T,) of a point (3,) of the object's frame along any one axis, metres.

        The root of a third of the trace of its covariance.
        """
        arms = self.points(point) - self.positions
        by_turn = np.zeros((len(self), 3, 3))
        by_turn[:, 0, 1], by_turn[:, 0, 2], by_turn[:, 1, 2] = arms[:, 2], -arms[:, 1], arms[:, 0]
        by_turn -= by_turn.transpose(0, 2, 1)
        jacobians = np.concatenate([np.tile(np.eye(3), (len(self), 1, 1)), by_turn], axis=2)
        covariances = jacobians @ self.covariances @ jacobians.transpose(0, 2, 1)
        return np.sqrt(np.trace(covariances, axis1=1, axis2=2) / 3.0)

    def turn_deviations(self) -> Array:
        """Standard deviation (T,) of the rotation about any one axis, radians."""
        return np.sqrt(np.trace(self.covariances[:, 3:, 3:], axis1=1, axis2=2) / 3.0)
