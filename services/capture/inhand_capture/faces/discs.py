"""Discs of pictures, in which something is hidden."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inhand_capture.estimation.found_person import Floats


@dataclass(frozen=True, slots=True)
class Disc:
    """A disc about (x, y) in a picture, in pixels; it may reach out of it."""

    x: float
    y: float
    radius: float

    def distance(self, other: "Disc") -> float:
        """Distance of two discs' centres, pixels."""
        return math.hypot(self.x - other.x, self.y - other.y)

    def grown(self, factor: float) -> "Disc":
        """The disc with so many times its radius."""
        return Disc(self.x, self.y, factor * self.radius)

    def scaled(self, scale: float) -> "Disc":
        """The same disc in the picture at so many times its size."""
        return Disc(scale * (self.x + 0.5) - 0.5, scale * (self.y + 0.5) - 0.5, scale * self.radius)


def mask_of_discs(
    discs: Iterable[Disc], size: tuple[int, int], shape: tuple[int, int]
) -> NDArray[np.bool_]:
    """Return the pixels (H, W) of ``shape`` that discs touch, which are of a picture of ``size``.

    Both are (height, width): depth may be of another size than the colour that faces are found in.
    """
    mask = np.zeros(shape, bool)
    down, across = (wanted / given for wanted, given in zip(shape, size, strict=True))
    for disc in discs:
        rows, y = _span((disc.y + 0.5) * down - 0.5, disc.radius * down + 1.0, shape[0])
        columns, x = _span((disc.x + 0.5) * across - 0.5, disc.radius * across + 1.0, shape[1])
        mask[rows, columns] |= y[:, None] ** 2 + x**2 <= 1.0
    return mask


def _span(centre: float, reach: float, length: int) -> tuple[slice, Floats]:
    """Return the pixels of an axis within reach, and how far off they are, in reaches."""
    first = min(max(math.floor(centre - reach), 0), length)
    last = min(max(math.ceil(centre + reach) + 1, first), length)
    offsets = (np.arange(first, last, dtype=np.float64) - centre) / reach
    return slice(first, last), offsets
