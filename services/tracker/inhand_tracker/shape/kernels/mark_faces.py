"""Pixels whose centre lies in a face of a mesh."""

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array, Bytes, Indices


@njit(cache=True, nogil=True)
def mark_faces(pixels: Array, faces: Indices, mask: Bytes) -> None:
    """Set ``mask`` (H, W) to 1 where a pixel's centre lies in one of the faces (F, 3), whichever
    way it faces, of vertices at ``pixels`` (V, 2).

    Other than ``draw_faces`` it draws no lines along edges: it takes no more pixels, on average,
    than the faces have area.
    """
    height, width = mask.shape
    for face in range(faces.shape[0]):
        a, b, c = faces[face]
        ax, ay = pixels[a]
        bx, by = pixels[b]
        cx, cy = pixels[c]
        top = max(0, int(np.ceil(min(ay, by, cy))))
        bottom = min(height - 1, int(np.floor(max(ay, by, cy))))
        for row in range(top, bottom + 1):
            left, right = np.inf, -np.inf
            for x, y, u, v in ((ax, ay, bx, by), (bx, by, cx, cy), (cx, cy, ax, ay)):
                if min(y, v) <= row <= max(y, v) and y != v:
                    column = x + (row - y) / (v - y) * (u - x)
                    left, right = min(left, column), max(right, column)
            if left > right:
                continue
            last = int(np.floor(min(right, width - 1.0)))
            for place in range(int(np.ceil(max(left, 0.0))), last + 1):
                mask[row, place] = 1
