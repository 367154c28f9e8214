"""Describes a movement by what all sensors of skeletons measure alike: shoulders, elbows, wrists.

Where a trunk's and a hand's joints lie each sensor decides for itself, and so do lengths.
Directions of upper arms and forearms are much the same in all of them, seen from a trunk whose up
is the way from between the hips to between the shoulders. So a movement is judged by these where a
body is unlike all that were learned.
"""

from dataclasses import replace

import numpy as np
from inhand_schemas.joints import Joint

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.recognition.movement_classes import MovementClasses
from inhand_tracker.recognition.movement_window import MovementWindow
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION, RecognitionParameters

UPPER_ARM, FOREARM, HALF_BREADTH = 0.55, 0.45, 0.35
"""Lengths of the parts of an arm, and half of the shoulders' breadth, in lengths of an arm."""
SHORTEST = 1e-9
"""Length below which a limb has no direction."""
_RIGHT = (Joint.SHOULDER_RIGHT, Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT)
_LEFT = (Joint.SHOULDER_LEFT, Joint.ELBOW_LEFT, Joint.WRIST_LEFT)


def arm_window(parameters: RecognitionParameters = DEFAULT_RECOGNITION) -> MovementWindow:
    """Make a window that reads the arms."""
    arms = replace(parameters, windows=parameters.arm_windows, lags=parameters.arm_lags)
    return MovementWindow(arms, arm_description)


def arm_description(pose: Array) -> Array:
    """Describe the arms of a body pose (60,), as (16,).

    For each arm the upper arm's direction, where the wrist is and how straight the elbow, then how
    far the wrists are apart, and how upright the trunk is on the legs.
    """
    joints = pose.reshape(20, 3)
    shoulders = 0.5 * (joints[Joint.SHOULDER_LEFT] + joints[Joint.SHOULDER_RIGHT])
    hips = 0.5 * (joints[Joint.HIP_LEFT] + joints[Joint.HIP_RIGHT])
    ankles = 0.5 * (joints[Joint.ANKLE_LEFT] + joints[Joint.ANKLE_RIGHT])
    breadth = _unit(joints[Joint.SHOULDER_LEFT] - joints[Joint.SHOULDER_RIGHT])
    up = _unit(shoulders - hips)
    across = breadth + _unit(joints[Joint.HIP_LEFT] - joints[Joint.HIP_RIGHT])
    left = _unit(across - (across @ up) * up)
    to_trunk = np.stack((left, up, np.cross(left, up)))
    described, wrists = [], []
    for chain, side in ((_RIGHT, -HALF_BREADTH), (_LEFT, HALF_BREADTH)):
        shoulder, elbow, wrist = joints[list(chain)]
        upper, fore = to_trunk @ _unit(elbow - shoulder), to_trunk @ _unit(wrist - elbow)
        wrists.append(side * (to_trunk @ breadth) + UPPER_ARM * upper + FOREARM * fore)
        described += [upper, wrists[-1], [upper @ fore]]
    apart = np.linalg.norm(wrists[0] - wrists[1])
    return np.concatenate([*described, [apart, up @ _unit(hips - ankles)]])


def arm_evidence(
    arms: MovementClasses,
    features: Array,
    parameters: RecognitionParameters = DEFAULT_RECOGNITION,
) -> Array:
    """Log evidence (N, K + 1) of the arms' features (N, D), for each action and, last, for none.

    It is how much likelier they are with the action than with nothing in use. It is bounded, and
    the less the farther they are from the action: far from all that was learned it says nothing.
    """
    logs = arms.log_likelihoods(features)
    ratios = np.clip(logs[:, :-1] - logs[:, -1:], -parameters.most_said, parameters.most_said)
    far = np.maximum(arms.apart(features) - parameters.arm_reach, 0.0)
    evidence = np.zeros_like(logs)
    evidence[:, :-1] = ratios - parameters.arm_doubt * far - parameters.arm_caution
    return evidence


def _unit(vector: Array) -> Array:
    return np.asarray(vector / max(float(np.linalg.norm(vector)), SHORTEST))
