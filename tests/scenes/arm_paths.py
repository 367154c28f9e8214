"""Somebody who stands and moves a straight right arm, as body poses at any rate."""

import numpy as np
from inhand_schemas.joints import Joint
from people import STANDING

POSE = (STANDING - STANDING[Joint.HIP_CENTER]) / 1.7
ARM = 0.3
"""Length of the arm in statures."""

Path = tuple[tuple[float, float, float], ...]
"""Seconds, then degrees to the right and up of an arm that points ahead."""
TimedPoses = list[tuple[int, np.ndarray]]
HANGING = (0.0, -85.0)
LIFT_AND_SWEEP: Path = ((0.0, *HANGING), (0.9, 0, 30), (1.6, 80, 30), (2.3, 80, -60))
SWEEP_FROM_BEHIND: Path = ((0.0, 80, -60), (0.7, 80, 30), (1.4, 0, 30), (2.3, *HANGING))
"""The same way backwards."""
FLAP: Path = ((0.0, 90, -85), (0.5, 90, 0), (1.0, 90, -70), (1.5, 90, 0), (2.2, 90, -85))


def arm_poses(
    path: Path, rate_hz: float = 30.0, tempo: float = 1.0
) -> list[tuple[int, np.ndarray]]:
    """Times in nanoseconds and body poses (60,) along a path."""
    seconds, azimuths, elevations = np.array(path).T
    moments = np.arange(0.0, seconds[-1] / tempo, 1.0 / rate_hz)
    arms = [np.interp(tempo * moments, seconds, values) for values in (azimuths, elevations)]
    return [
        (round(moment * 1e9), arm_pose(azimuth, elevation))
        for moment, azimuth, elevation in zip(moments, *arms, strict=True)
    ]


def arm_pose(azimuth: float, elevation: float) -> np.ndarray:
    """Body pose (60,) of an arm that points so, in degrees."""
    aside, up = np.radians((azimuth, elevation))
    ahead = np.cos(up) * np.cos(aside)
    direction = np.array([-np.cos(up) * np.sin(aside), -np.sin(up), -ahead])
    joints = POSE.copy()
    joints[Joint.ELBOW_RIGHT] = joints[Joint.SHOULDER_RIGHT] + 0.55 * ARM * direction
    joints[Joint.WRIST_RIGHT] = joints[Joint.SHOULDER_RIGHT] + ARM * direction
    hanging = np.array([0.0, ARM, 0.0])
    joints[Joint.ELBOW_LEFT] = joints[Joint.SHOULDER_LEFT] + 0.55 * hanging
    joints[Joint.WRIST_LEFT] = joints[Joint.SHOULDER_LEFT] + hanging
    return joints.ravel()
