"""Pixels of forearms and hands: lines of some width between joints."""

from typing import NamedTuple

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array, Bytes, Indices, Singles
from inhand_tracker.geometry.camera import NEAREST_M
from inhand_tracker.sight.kernels.projection import projected

FARTHEST_PIXEL = 1e4
"""Pixel beyond which a limb is nowhere near the image."""


class LimbSizes(NamedTuple):
    """Radii of a forearm and a hand, how far fingers reach beyond the hand's joint, and how far
    before and behind a limb a measured depth may be its: all in metres."""

    forearm_m: float
    hand_m: float
    fingers_m: float
    depth_m: float


@njit(cache=True, nogil=True)
def _mark_limb(
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


@njit(cache=True, nogil=True)
def mark_limbs(
    joints: Array, arms: Indices, lens: Array, sizes: LimbSizes, depth: Singles, mask: Bytes
) -> None:
    """Set ``mask`` (H, W) to 1 where the limbs of ``joints`` (20, 3) may be: an elbow, a wrist and
    a hand for each of ``arms`` (2, 3). The ``lens`` is (fx, fy, cx, cy)."""
    ends, pixels = np.empty((2, 3)), np.empty((2, 2))
    for side in range(len(arms)):
        elbow, wrist, hand = joints[arms[side, 0]], joints[arms[side, 1]], joints[arms[side, 2]]
        along = hand - wrist
        length = max(np.sqrt((along * along).sum()), 1e-6)
        for limb in range(2):
            ends[0], ends[1] = wrist, elbow
            radius = sizes.forearm_m
            if limb == 1:
                ends[1] = hand + along * (sizes.fingers_m / length)
                radius = sizes.hand_m
            nearest, farthest = min(ends[0, 2], ends[1, 2]), max(ends[0, 2], ends[1, 2])
            if not nearest > NEAREST_M:
                continue
            for end in range(2):
                x, y, z = ends[end]
                pixels[end, 0], pixels[end, 1] = projected(lens, x, y, z)
            if not np.abs(pixels).max() <= FARTHEST_PIXEL:
                continue
            _mark_limb(
                (pixels[0, 0], pixels[0, 1], pixels[1, 0], pixels[1, 1]),
                max(0.5, radius * lens[0] / nearest),
                (nearest - sizes.depth_m, farthest + sizes.depth_m),
                depth,
                mask,
            )
