"""Where in an image the person's forearms and hands may cover an object."""

import cv2
import numpy as np
from inhand_schemas.joints import JOINT_NAMES

from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.geometry.camera import NEAREST_M, Intrinsics
from inhand_tracker.sight.parameters import DEFAULT_SIGHT, SightParameters

THICKEST_LINE = 255
"""Pixels of the thickest line that OpenCV draws here."""
FARTHEST_PIXEL = 1e4
"""Pixel beyond which a limb is nowhere near the image, and OpenCV's lines overflow."""

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
    for elbow, wrist, hand in joints[_ARMS]:
        along = hand - wrist
        length = np.linalg.norm(along)
        tip = hand + (parameters.fingers_m * along / length if length > 1e-6 else 0.0)
        for ends, radius in (
            (np.array([elbow, wrist]), parameters.forearm_m),
            (np.array([wrist, tip]), parameters.hand_m),
        ):
            limb = _limb(ends, radius, camera)
            if limb is None:
                continue
            if depth is not None:
                nearest, farthest = ends[:, 2].min(), ends[:, 2].max()
                behind = depth > float(farthest) + parameters.limb_depth_m
                before = (depth > 0.0) & (depth < float(nearest) - parameters.limb_depth_m)
                limb[behind | before] = 0
            np.maximum(mask, limb, out=mask)
    return mask


def _limb(ends: Array, radius: float, camera: Intrinsics) -> Bytes | None:
    """Draw the pixels (H, W) of a limb between two points (2, 3); None where it is not before the
    camera."""
    if not (np.isfinite(ends).all() and (ends[:, 2] > NEAREST_M).all()):
        return None
    pixels = camera.project(ends)
    if np.abs(pixels).max() > FARTHEST_PIXEL:
        return None
    limb = np.zeros((camera.height, camera.width), np.uint8)
    thickness = max(1, round(2.0 * radius * camera.fx / float(ends[:, 2].min())))
    first, last = np.rint(pixels).astype(int).tolist()
    cv2.line(limb, first, last, 1, min(thickness, THICKEST_LINE))
    return limb
