"""The twenty joints of a skeleton: Kinect's, in Kinect's order."""

from enum import IntEnum


class Joint(IntEnum):
    """A joint's place in every array of joints; left is the person's own left."""

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


JOINT_NAMES = tuple(joint.name.title().replace("_", "") for joint in Joint)
"""The joints' names as files and other languages know them: ``HipCenter`` and so on."""

SIDES = ("Left", "Right")

PARENTS = (-1, 0, 1, 2, 2, 4, 5, 6, 2, 8, 9, 10, 0, 12, 13, 14, 0, 16, 17, 18)
"""Parent of each joint in the kinematic tree; the first joint has none."""

MIRRORED_JOINTS = (0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 16, 17, 18, 19, 12, 13, 14, 15)
"""The same joint on the body's other side, for each joint."""
