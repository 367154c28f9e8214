"""The room's frame: z up, the floor at z = 0, and how it lies to the rig's."""

from dataclasses import dataclass, replace

import numpy as np

from inhand_outcomes.arrays import Array
from inhand_outcomes.rotations import multiply, of_matrix
from inhand_outcomes.track import Track

CAMERA_UP = np.array([0.0, -1.0, 0.0])
"""Up in the frame of a camera that is held level."""


@dataclass(frozen=True)
class Room:
    """Where up is in the rig, a unit vector (3,), and the floor: the points p with
    ``up @ p == floor_height``; None where no floor was found yet."""

    up: Array
    floor_height: float | None = None

    @property
    def matrix(self) -> Array:
        """room_from_rig's rotation (3, 3): up becomes z; the rig's z, as far as it is level, y."""
        forward = np.array([0.0, 0.0, 1.0]) - self.up[2] * self.up
        if np.linalg.norm(forward) < 0.1:  # a camera that looks straight up or down
            forward = np.array([0.0, 1.0, 0.0]) - self.up[1] * self.up
        forward /= np.linalg.norm(forward)
        return np.stack([np.cross(forward, self.up), forward, self.up])

    @property
    def translation(self) -> Array:
        """room_from_rig's translation (3,)."""
        return np.array([0.0, 0.0, -(self.floor_height or 0.0)])

    def place(self, track: Track) -> Track:
        """Bring a track from the rig's frame into the room's."""
        turn = self.matrix
        both = np.kron(np.eye(2), turn)
        rotations = multiply(of_matrix(turn), track.poses[:, 3:])
        joints = track.joints @ turn.T + self.translation
        return replace(
            track,
            poses=np.hstack([track.positions @ turn.T + self.translation, rotations]),
            covariances=both @ track.covariances @ both.T,
            joints=joints,
            floor=self.floor_height is not None,
        )


LEVEL = Room(CAMERA_UP)
"""What is assumed before anything is known: the camera is held level."""
