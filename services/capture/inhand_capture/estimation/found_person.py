"""What a pose network says of one person, and what a network is to the rest of capture."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from numpy import float64, uint8
from numpy.typing import NDArray

Floats = NDArray[float64]


@dataclass(frozen=True)
class FoundPerson:
    """One person as a network finds them in a picture, joint by joint in our order.

    ``pixels`` (20, 2) are x, y in the picture, NaN for joints that the network does not know.
    ``depths`` (20,) are metres behind the middle of the hips, NaN where it says none.
    ``visibilities`` (20,) are its probabilities, 0 to 1, that a joint is in view.
    """

    pixels: Floats
    depths: Floats
    visibilities: Floats


class PoseNetwork(Protocol):
    """Finds people in pictures that follow each other; it may remember where they were.

    The trunk's joints (HipCenter, Spine, ShoulderCenter) are derived from hips and shoulders in
    space: no network need know them.
    """

    def find(self, colour: NDArray[uint8]) -> Sequence[FoundPerson]:
        """Find the people in a picture (H, W, 3) RGB."""
