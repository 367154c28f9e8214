"""The nearest point of a mesh in each pixel (the lab's ``canvas`` paints pictures instead)."""

import numpy as np

from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.shape.kernels.draw_faces import draw_faces


def nearest_depths(pixels: Array, depths: Array, faces: Indices, size: tuple[int, int]) -> Array:
    """Find the depth of the nearest surface in each pixel of a ``size`` (H, W); infinite for none.

    ``pixels`` (V, 2) and ``depths`` (V,) are the projected vertices, ``faces`` (F, 3). The edges
    of faces are drawn as lines, so that nothing is too thin to be seen.
    """
    return nearest_faces(pixels, depths, faces, size)[0]


def nearest_faces(
    pixels: Array, depths: Array, faces: Indices, size: tuple[int, int]
) -> tuple[Array, Indices]:
    """Find ``nearest_depths``, and which face is seen there, (H, W), -1 for none."""
    buffer = np.full(size, np.inf)
    owners = np.full(size, -1)
    draw_faces(pixels, depths, faces, buffer, owners)
    return buffer, owners
