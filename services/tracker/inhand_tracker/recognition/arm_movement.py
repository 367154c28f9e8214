"""Describes a movement by what all sensors of skeletons measure alike: shoulders, elbows, wrists.

Where a trunk's and a hand's joints lie each sensor decides for itself, and so do lengths.
Directions of upper arms and forearms are much the same in all of them, seen from a trunk whose up
is the way from between the hips to between the shoulders. So a movement is judged by these where a
body is unlike all that were learned (``arm_courses``).
"""

import numpy as np
from inhand_schemas.joints import Joint

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION, RecognitionParameters

UPPER_ARM, FOREARM, HALF_BREADTH = 0.55, 0.45, 0.35
"""Lengths of the parts of an arm, and half of the shoulders' breadth, in lengths of an arm."""
SHORTEST = 1e-9
"""Length below which a limb has no direction."""
WRISTS, MOVED, UPPER_ARMS = slice(0, 6), slice(6, 12), slice(12, 18)
"""Parts of an observation, each of the right arm, then the left one."""
OBSERVATION = 18
"""Length of an observation."""
_RIGHT = (Joint.SHOULDER_RIGHT, Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT)
_LEFT = (Joint.SHOULDER_LEFT, Joint.ELBOW_LEFT, Joint.WRIST_LEFT)


def arm_description(pose: Array) -> Array:
    """Describe the arms of a body pose (60,), as (12,): both wrists, then both upper arms.

    The right one comes first. A wrist is placed from between the shoulders, in lengths of an arm;
    an upper arm is a direction. Axes point to the left, up and ahead of the trunk.
    """
    joints = pose.reshape(20, 3)
    shoulders = 0.5 * (joints[Joint.SHOULDER_LEFT] + joints[Joint.SHOULDER_RIGHT])
    hips = 0.5 * (joints[Joint.HIP_LEFT] + joints[Joint.HIP_RIGHT])
    breadth = _unit(joints[Joint.SHOULDER_LEFT] - joints[Joint.SHOULDER_RIGHT])
    up = _unit(shoulders - hips)
    across = breadth + _unit(joints[Joint.HIP_LEFT] - joints[Joint.HIP_RIGHT])
    left = _unit(across - (across @ up) * up)
    to_trunk = np.stack((left, up, np.cross(left, up)))
    wrists, uppers = [], []
    for chain, side in ((_RIGHT, -HALF_BREADTH), (_LEFT, HALF_BREADTH)):
        shoulder, elbow, wrist = joints[list(chain)]
        upper, fore = to_trunk @ _unit(elbow - shoulder), to_trunk @ _unit(wrist - elbow)
        wrists.append(side * (to_trunk @ breadth) + UPPER_ARM * upper + FOREARM * fore)
        uppers.append(upper)
    return np.concatenate(wrists + uppers)


class ArmReader:
    """Reads observations of one person's arms at a steady rate, whatever the frames' rate.

    An observation (18,) is both wrists' places, how far they moved in the last fifth of a second,
    and the upper arms' directions. Between frames the arms are taken to move evenly; a clock that
    goes back, or a long gap, starts anew.
    """

    def __init__(self, parameters: RecognitionParameters = DEFAULT_RECOGNITION) -> None:
        self._longest_ns = round(parameters.longest_step_s * 1e9)
        self._period_ns = round(1e9 / parameters.arms.rate_hz)
        self._lag = parameters.arms.lag
        self._described: list[Array] = []
        self._last: tuple[int, Array] | None = None
        self._due_ns = 0

    def read(self, time_ns: int, pose: Array) -> list[Array]:
        """Return the observations that the body pose (60,) of a frame completes, oldest first."""
        arms = arm_description(pose)
        if self._last is None or not 0 < time_ns - self._last[0] <= self._longest_ns:
            self._described, self._last, self._due_ns = [], None, time_ns
        observations = []
        # Clocks jitter.
        while self._due_ns <= time_ns + self._period_ns // 8:
            observations.append(self._observe(self._at(self._due_ns, time_ns, arms)))
            self._due_ns += self._period_ns
        self._last = (time_ns, arms)
        return observations

    def _at(self, moment_ns: int, time_ns: int, arms: Array) -> Array:
        """The arms (12,) at a moment between the last frame and this one."""
        if self._last is None or moment_ns >= time_ns:
            return arms
        before_ns, before = self._last
        share = (moment_ns - before_ns) / (time_ns - before_ns)
        return np.asarray(before + max(share, 0.0) * (arms - before))

    def _observe(self, arms: Array) -> Array:
        self._described = [*self._described[-self._lag :], arms]
        wrists = arms[WRISTS]
        moved = wrists - self._described[0][WRISTS]
        return np.concatenate((wrists, moved, arms[6:]))


def _unit(vector: Array) -> Array:
    return np.asarray(vector / max(float(np.linalg.norm(vector)), SHORTEST))
