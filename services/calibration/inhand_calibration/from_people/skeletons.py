"""What a camera made of people over time: the input of a calibration from people."""

from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import Joint

from inhand_calibration.arrays import Array, Indices


@dataclass(frozen=True)
class CameraSkeletons:
    """The people that one camera saw: a row for each person in each frame, N in all.

    ``times_ns`` (N,) are by the camera's own clock, and do not fall; ``people`` (N,) are numbers
    that a person keeps for as long as the camera follows them, and need not be the same in other
    cameras; ``joints`` (N, 20, 3) are in the camera's frame, metres, NaN where missing;
    ``confidences`` (N, 20) are 0 to 1. Raises ValueError where shapes do not fit or times fall.
    """

    name: str
    times_ns: Indices
    people: Indices
    joints: Array
    confidences: Array

    def __post_init__(self) -> None:
        count = len(self.times_ns)
        shape = (count, len(Joint))
        shapes = (self.people.shape, self.joints.shape, self.confidences.shape)
        if shapes != ((count,), (*shape, 3), shape):
            raise ValueError(
                f"{self.name}: people, joints and confidences of {count} rows have shapes {shapes}"
            )
        if np.any(np.diff(self.times_ns) < 0):
            raise ValueError(f"{self.name}: times fall")
