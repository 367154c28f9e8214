"""The joints of one person over a recording, simulated or measured."""

from dataclasses import dataclass

from inhand_tracker.geometry.arrays import Array, Indices


@dataclass(frozen=True)
class JointSequence:
    """The joints (T, 20, 3) of one person at ``times_ns`` (T,), in the camera frame.

    They are in metres, NaN where missing.
    """

    action: str
    participant: str
    left_handed: bool
    joints: Array
    times_ns: Indices
