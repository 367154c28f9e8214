"""The twenty joints of a Kinect skeleton."""

from __future__ import annotations

from enum import IntEnum

import numpy as np


class Joint(IntEnum):
    """Kinect's twenty joints in Kinect's order; left is the person's own left."""

    HIP_CENTER = 0
    SPINE = 1
    SHOULDER_CENTER = 2
    HEAD = 3
    SHOULDER_LEFT = 4
    ELBOW_LEFT = 5
    WRIST_LEFT = 6
    HAND_LEFT = 7
    SHOULDER_RIGHT = 8
    ELBOW_RIGHT = 9
    WRIST_RIGHT = 10
    HAND_RIGHT = 11
    HIP_LEFT = 12
    KNEE_LEFT = 13
    ANKLE_LEFT = 14
    FOOT_LEFT = 15
    HIP_RIGHT = 16
    KNEE_RIGHT = 17
    ANKLE_RIGHT = 18
    FOOT_RIGHT = 19


PARENTS = (-1, 0, 1, 2, 2, 4, 5, 6, 2, 8, 9, 10, 0, 12, 13, 14, 0, 16, 17, 18)
"""Parent of each joint in the kinematic tree."""

MIRRORED_JOINTS = np.array(
    [0, 1, 2, 3, *range(8, 12), *range(4, 8), *range(16, 20), *range(12, 16)]
)
"""For each joint its counterpart on the other side."""
