"""How long a person's limbs are: usual lengths, and one's own over the last frames."""

import numpy as np
from inhand_runtime.running_medians import RunningMedians
from inhand_schemas.joints import Joint
from numpy.typing import NDArray

from inhand_capture.estimation.found_person import Floats
from inhand_capture.estimation.kernels.depth_choice import TRACKED
from inhand_capture.estimation.limbs import HIPS, LIMBS, SHOULDERS, TRUNK_ENDS
from inhand_capture.estimation.parameters import DEFAULT_LIFTING, LiftingParameters

OUTER = np.concatenate([limb[1:] for limb in LIMBS])
INNER = np.concatenate([limb[:-1] for limb in LIMBS])


def usual_lengths(parameters: LiftingParameters) -> Floats:
    """Return usual distances (20,) of a limb's joints from the one before, in trunks; NaN for the
    trunk's own joints."""
    lengths = np.full(len(Joint), np.nan)
    shares = {
        "ELBOW": parameters.upper_arm,
        "WRIST": parameters.forearm,
        "HAND": parameters.hand,
        "KNEE": parameters.thigh,
        "ANKLE": parameters.shank,
        "FOOT": parameters.foot,
    }
    for name, share in shares.items():
        for side in ("LEFT", "RIGHT"):
            lengths[Joint[f"{name}_{side}"]] = share
    return lengths


class BodyLengths:
    """Keeps one person's limb lengths, as medians over the frames that measured both ends."""

    def __init__(self, parameters: LiftingParameters = DEFAULT_LIFTING) -> None:
        self._medians = RunningMedians(len(OUTER) + 1, parameters.length_frames)
        self._fewest = parameters.own_lengths_from
        self.lengths: Floats = np.full(len(Joint), np.nan)
        """Distances (20,) of each joint from the one before, metres; NaN while unknown."""
        self.trunk = float("nan")
        """Distance from the middle of the shoulders to that of the hips; NaN while unknown."""

    def add(self, seen: Floats, states: NDArray[np.uint8]) -> None:
        """Take one frame's joints (20, 3) as a network sees them, with their states (20,)."""
        lengths = np.linalg.norm(seen[OUTER] - seen[INNER], axis=1)
        measured = (states[OUTER] == TRACKED) & (states[INNER] == TRACKED)
        trunk = trunk_length(seen) if (states[list(TRUNK_ENDS)] == TRACKED).all() else np.nan
        medians = self._medians.update(np.append(np.where(measured, lengths, np.nan), trunk))
        own = np.where(self._medians.counts >= self._fewest, medians, np.nan)
        self.lengths[OUTER], self.trunk = own[:-1], float(own[-1])


def trunk_length(joints: Floats) -> float:
    """Return the distance from the middle of the shoulders to that of the hips, of joints
    (20, 2 or 3)."""
    shoulders, hips = (joints[list(pair)].mean(axis=0) for pair in (SHOULDERS, HIPS))
    return float(np.linalg.norm(shoulders - hips))
