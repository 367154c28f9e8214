"""Pixels of a limb: a line of some width between two points."""

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Bytes, Singles


@njit(cache=True, nogil=True)
def mark_limb(
    ends: tuple[float, float, float, float],
    radius: float,
    depths: tuple[float, float],
    depth: Singles,
    mask: Bytes,
) -> None:
    """Set ``mask`` (H, W) to 1 within ``radius`` pixels of the line between two ``ends`` (u, v, u,
    v), where the measured ``depth`` (H, W) is 0, none, or between two ``depths``."""
    au, av, bu, bv = ends
    nearest, farthest = depths
    height, width = mask.shape
    along_u, along_v = bu - au, bv - av
    square = max(along_u * along_u + along_v * along_v, 1e-12)
    top, bottom = max(0, int(min(av, bv) - radius)), min(height - 1, int(max(av, bv) + radius) + 1)
    left, right = max(0, int(min(au, bu) - radius)), min(width - 1, int(max(au, bu) + radius) + 1)
    for row in range(top, bottom + 1):
        for column in range(left, right + 1):
            if mask[row, column]:
                continue
            off_u, off_v = column - au, row - av
            share = min(max((off_u * along_u + off_v * along_v) / square, 0.0), 1.0)
            off_u, off_v = off_u - share * along_u, off_v - share * along_v
            if off_u * off_u + off_v * off_v > radius * radius:
                continue
            measured = depth[row, column]
            if measured == np.float32(0.0) or nearest <= measured <= farthest:
                mask[row, column] = 1
