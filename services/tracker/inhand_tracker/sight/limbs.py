"""Where in an image the person's forearms and hands may cover an object."""

import numpy as np
from inhand_schemas.joints import JOINT_NAMES

from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.sight.kernels.mark_limb import mark_limb
from inhand_tracker.sight.parameters import DEFAULT_SIGHT, SightParameters

FARTHEST_PIXEL = 1e4
"""Pixel beyond which a limb is nowhere near the image."""

_ARMS = [
    [JOINT_NAMES.index(joint + side) for joint in ("Elbow", "Wrist", "Hand")]
    for side in ("Left", "Right")
]


def limb_mask(
    joints: Array | None,
    camera: Intrinsics,
    depth: Singles | None,
    parameters: SightParameters = DEFAULT_SIGHT,
) -> Bytes:
    """Mark pixels (H, W) with 1 where a forearm or hand of joints (20, 3) in the camera frame may
    be seen.

    Where depth was measured it must be about that of the limb. Missing joints (NaN) hide nothing.
    """
    mask = np.zeros((camera.height, camera.width), np.uint8)
    if joints is None:
        return mask
    depth = np.zeros(mask.shape, np.float32) if depth is None else depth
    ends = _limbs(joints, parameters)
    pixels = camera.project(ends)
    for limb, radius, points in zip(pixels, np.tile(_radii(parameters), 2), ends, strict=True):
        # Missing joints and those behind the camera have no pixels.
        if not np.abs(limb).max() <= FARTHEST_PIXEL:
            continue
        nearest, farthest = points[:, 2].min(), points[:, 2].max()
        within = float(nearest) - parameters.limb_depth_m, float(farthest) + parameters.limb_depth_m
        thickness = max(0.5, radius * camera.fx / float(nearest))
        mark_limb((*limb[0], *limb[1]), thickness, within, depth, mask)
    return mask


def _radii(parameters: SightParameters) -> list[float]:
    return [parameters.forearm_m, parameters.hand_m]


def _limbs(joints: Array, parameters: SightParameters) -> Array:
    """Find the ends (4, 2, 3) of each side's forearm and hand, with its fingers."""
    elbows, wrists, hands = np.swapaxes(joints[_ARMS], 0, 1)
    along = hands - wrists
    length = np.sqrt(np.square(along).sum(axis=1, keepdims=True))
    tips = hands + along * (parameters.fingers_m / np.maximum(length, 1e-6))
    ends = np.array([[elbows, wrists], [wrists, tips]])
    return np.ascontiguousarray(ends.transpose(2, 0, 1, 3)).reshape(4, 2, 3)
