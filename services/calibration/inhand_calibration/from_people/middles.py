"""Points of a body that do not depend on which of its sides is called left."""

import numpy as np
from inhand_schemas.joints import Joint

from inhand_calibration.arrays import Array, Flags

TRUNK = (Joint.HIP_CENTER, Joint.SPINE, Joint.SHOULDER_CENTER, Joint.HEAD)
LEFT = (
    Joint.SHOULDER_LEFT,
    Joint.ELBOW_LEFT,
    Joint.WRIST_LEFT,
    Joint.HIP_LEFT,
    Joint.KNEE_LEFT,
    Joint.ANKLE_LEFT,
)
RIGHT = (
    Joint.SHOULDER_RIGHT,
    Joint.ELBOW_RIGHT,
    Joint.WRIST_RIGHT,
    Joint.HIP_RIGHT,
    Joint.KNEE_RIGHT,
    Joint.ANKLE_RIGHT,
)


def middles(joints: Array, support: Array) -> tuple[Array, Flags]:
    """Return the trunk's joints and the middles of pairs (..., 10, 3) of joints (..., 20, 3), and
    where (..., 10) they are known; ``support`` (..., 20) is 0 where a joint is not."""
    pairs = 0.5 * (joints[..., LEFT, :] + joints[..., RIGHT, :])
    known = support > 0.0
    both = known[..., LEFT] & known[..., RIGHT]
    return (
        np.concatenate([joints[..., TRUNK, :], pairs], axis=-2),
        np.concatenate([known[..., TRUNK], both], axis=-1),
    )
