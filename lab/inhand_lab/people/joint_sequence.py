"""The joints of one person over a recording, simulated or measured."""

from dataclasses import dataclass

from inhand_tracker.geometry.arrays import Array, Indices


@dataclass(frozen=True)
class JointSequence:
    """One recording of one person: joints (T, 20, 3) in the camera frame, NaN where missing, at
    ``times_ns`` (T,)."""

    action: str
    participant: str
    left_handed: bool
    joints: Array
    times_ns: Indices
