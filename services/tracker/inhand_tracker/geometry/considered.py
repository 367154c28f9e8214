"""What a tracker considered in a frame before it decided: for who wants to see why."""

from collections.abc import Mapping
from dataclasses import dataclass

from inhand_tracker.geometry.arrays import Array

PlacedPose = tuple[Array, Array]
"""A translation (3,) in metres and a rotation (4,), camera_from_object."""


@dataclass(frozen=True)
class Considered:
    """Poses of the object in the camera frame that were considered in one frame.

    The hypotheses have ``translations`` (P, 3) in metres, ``rotations`` (P, 4) and ``weights``
    (P,), which sum to 1; P is 0 where no image was looked at. ``predictions`` are what parts of the
    body say, each by itself and by its name.
    """

    translations: Array
    rotations: Array
    weights: Array
    predictions: Mapping[str, PlacedPose]
