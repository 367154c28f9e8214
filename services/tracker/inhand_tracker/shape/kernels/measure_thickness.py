"""How thick a silhouette is at points of its outline."""

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array, Flags


@njit(cache=True, nogil=True)
def measure_thickness(mask: Flags, pixels: Array, normals: Array) -> tuple[Array, Array]:
    """Find how many pixels a mask (H, W) goes on inwards from ``pixels`` (B, 2) against their
    ``normals`` (B, 2), (B,), and how many its absence goes on outwards, (B,), infinite to the
    border."""
    height, width = mask.shape
    inside = np.empty(len(pixels))
    outside = np.full(len(pixels), np.inf)
    for point in range(len(pixels)):
        steps = 1
        while True:
            column = int(np.rint(pixels[point, 0] - steps * normals[point, 0]))
            row = int(np.rint(pixels[point, 1] - steps * normals[point, 1]))
            if not (0 <= column < width and 0 <= row < height) or not mask[row, column]:
                break
            steps += 1
        inside[point] = steps
        # A step and a half out, the normal's rounding no longer meets the outline itself.
        for step in range(2, width):
            column = int(np.rint(pixels[point, 0] + step * normals[point, 0]))
            row = int(np.rint(pixels[point, 1] + step * normals[point, 1]))
            if not (0 <= column < width and 0 <= row < height):
                break
            if mask[row, column]:
                outside[point] = step
                break
    return inside, outside
