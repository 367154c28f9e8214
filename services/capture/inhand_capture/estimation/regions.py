"""Square regions of a picture, turned with the person in them, and pixels of their crops."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from inhand_capture.estimation.found_person import Floats

PADDING_GREY = (128.0, 128.0, 128.0)
"""What the detector sees beside the picture: the middle of its range."""


@dataclass(frozen=True)
class Region:
    """A square of the picture: its centre, side (pixels), and turn (radians, clockwise as seen)."""

    x: float
    y: float
    side: float
    angle: float = 0.0

    def matrix(self, size: int) -> Floats:
        """Return the affine map (2, 3) from a crop of that size to the picture."""
        scale = self.side / size
        cosine, sine = scale * math.cos(self.angle), scale * math.sin(self.angle)
        half = 0.5 * size
        return np.array(
            [
                [cosine, -sine, self.x - half * cosine + half * sine],
                [sine, cosine, self.y - half * sine - half * cosine],
            ]
        )

    def to_picture(self, points: Floats, size: int) -> Floats:
        """Take points (N, 2) of a crop of that size to the picture."""
        matrix = self.matrix(size)
        there: Floats = points @ matrix[:, :2].T + matrix[:, 2]
        return there

    def turned(self, places: Floats) -> Floats:
        """Turn places (N, 3), whose x and y are along the region's sides, to the picture's."""
        cosine, sine = math.cos(self.angle), math.sin(self.angle)
        turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        there: Floats = places @ turn.T
        return there

    def scaled(self, share: float) -> "Region":
        """Return the region about the same centre whose side is that share of its own."""
        return Region(self.x, self.y, share * self.side, self.angle)


def whole_picture(width: int, height: int) -> Region:
    """Return the smallest square about a picture."""
    return Region(0.5 * width, 0.5 * height, float(max(width, height)))


Beside = Literal["grey", "edge", "mirror"]
_BORDERS: Mapping[Beside, int] = {
    "grey": cv2.BORDER_CONSTANT,
    "edge": cv2.BORDER_REPLICATE,
    "mirror": cv2.BORDER_REFLECT_101,
}


def crop(
    picture: NDArray[np.uint8], region: Region, size: int, *, beside: Beside
) -> NDArray[np.uint8]:
    """Cut a region (size, size, 3) out of a picture; ``beside`` it is grey, its last pixels, or its
    mirror image."""
    cut = cv2.warpAffine(
        picture,
        region.matrix(size),
        (size, size),
        flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
        borderMode=_BORDERS[beside],
        borderValue=PADDING_GREY,
    )
    return np.asarray(cut, np.uint8)


def region_of_circle(centre: Floats, rim: Floats, scale: float) -> Region:
    """Return the region about a body, of the middle of its hips and a point above its head."""
    across, up = rim - centre
    angle = 0.5 * math.pi - math.atan2(-up, across)
    wrapped = (angle + math.pi) % (2.0 * math.pi) - math.pi
    return Region(float(centre[0]), float(centre[1]), 2.0 * scale * math.hypot(across, up), wrapped)
