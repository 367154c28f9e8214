"""Kinect's joints of those that networks know, which lie elsewhere in the same body."""

import numpy as np
from inhand_schemas.joints import Joint
from numpy.typing import NDArray

from inhand_capture.estimation.found_person import Floats
from inhand_capture.estimation.kernels.depth_choice import INFERRED
from inhand_capture.estimation.limbs import HIPS, SHOULDERS
from inhand_capture.estimation.parameters import LiftingParameters

States = NDArray[np.uint8]


def as_kinect(seen: Floats, states: States, parameters: LiftingParameters) -> tuple[Floats, States]:
    """Return Kinect's joints (20, 3) and states (20,) of a network's, NaN where it knows none.

    The trunk's middle joints, and hands, feet and a head that the network lacks, are derived and so
    inferred.
    """
    joints, derived = seen.copy(), states.copy()
    shoulders, hips = (seen[list(pair)].mean(axis=0) for pair in (SHOULDERS, HIPS))
    up = shoulders - hips
    for joint, share in (
        (Joint.HIP_CENTER, parameters.hip_centre),
        (Joint.SPINE, parameters.spine),
        (Joint.SHOULDER_CENTER, parameters.shoulder_centre),
    ):
        joints[joint] = hips + share * up
        derived[joint] = INFERRED
    trunk = float(np.linalg.norm(up))
    ahead = forwards(seen)
    joints[Joint.HEAD] += parameters.head_above * up
    if np.isnan(seen[Joint.HEAD, 0]):
        joints[Joint.HEAD], derived[Joint.HEAD] = hips + parameters.head * up, INFERRED
    for side in ("LEFT", "RIGHT"):
        shoulder, elbow, wrist, hand = (
            Joint[f"{name}_{side}"] for name in ("SHOULDER", "ELBOW", "WRIST", "HAND")
        )
        knee, ankle, foot = (Joint[f"{name}_{side}"] for name in ("KNEE", "ANKLE", "FOOT"))
        joints[shoulder] = shoulders + parameters.shoulders_aside * (seen[shoulder] - shoulders)
        joints[elbow] += parameters.elbow_along * (seen[elbow] - seen[shoulder])
        joints[ankle] += parameters.ankle_along * (seen[ankle] - seen[knee])
        joints[foot] += parameters.foot_above * (seen[knee] - seen[ankle])
        if np.isnan(seen[hand, 0]) and states[wrist]:
            forearm = _unit(seen[wrist] - seen[elbow])
            joints[hand], derived[hand] = seen[wrist] + parameters.hand * trunk * forearm, INFERRED
        if np.isnan(seen[foot, 0]) and states[ankle]:
            toes = parameters.foot * trunk * ahead
            joints[foot], derived[foot] = seen[ankle] + toes, INFERRED
    return joints, derived


def forwards(seen: Floats) -> Floats:
    """Return the direction (3,) in which a body faces, by its hips and shoulders."""
    shoulders, hips = (seen[list(pair)] for pair in (SHOULDERS, HIPS))
    left = shoulders[0] - shoulders[1] + hips[0] - hips[1]
    return _unit(np.cross(left, shoulders.mean(axis=0) - hips.mean(axis=0)))


def _unit(vector: Floats) -> Floats:
    return vector / max(float(np.linalg.norm(vector)), 1e-9)
