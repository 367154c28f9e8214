"""The pinhole camera in numbers: what a picture's pixels are in directions."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Pinhole:
    """Focal lengths, principal point and image size, in pixels."""

    fx: float
    fy: float
    cx: float
    cy: float
    width: int
    height: int

    def scaled_to(self, width: int, height: int) -> Self:
        """Give the same view in an image of another size."""
        x, y = width / self.width, height / self.height
        return replace(
            self,
            fx=self.fx * x,
            fy=self.fy * y,
            cx=(self.cx + 0.5) * x - 0.5,
            cy=(self.cy + 0.5) * y - 0.5,
            width=width,
            height=height,
        )

    def rays(self, pixels: Floats) -> Floats:
        """Find x and y (N, 2), at a depth of 1, of what is seen at pixels (N, 2)."""
        return (pixels - [self.cx, self.cy]) / [self.fx, self.fy]
