"""Where in an image the person's forearms and hands may cover an object."""

import cv2
import numpy as np
from inhand_schemas.joints import JOINT_NAMES

from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.geometry.camera import NEAREST_M, Intrinsics

FOREARM_M = 0.05
"""The radius of a forearm, and what a measured wrist or elbow errs by."""
HAND_M = 0.08
FINGERS_M = 0.06
"""How far the fingers reach beyond the joint of the hand."""
SAME_DEPTH_M = 0.15
"""What lies farther behind a limb than this is not the limb."""

_ARMS = [
    [JOINT_NAMES.index(joint + side) for joint in ("Elbow", "Wrist", "Hand")]
    for side in ("Left", "Right")
]


def limb_mask(joints: Array | None, camera: Intrinsics, depth: Singles | None) -> Bytes:
    """(H, W): 1 where a forearm or hand of joints (20, 3) in the camera frame may be seen.

    Where depth was measured it must be about that of the limb. Missing joints (NaN) hide nothing.
    """
    mask = np.zeros((camera.height, camera.width), np.uint8)
    if joints is None:
        return mask
    for elbow, wrist, hand in joints[_ARMS]:
        _draw(mask, elbow, wrist, FOREARM_M, camera, depth)
        along = hand - wrist
        length = np.linalg.norm(along)
        tip = hand + (FINGERS_M * along / length if length > 1e-6 else 0.0)
        _draw(mask, wrist, tip, HAND_M, camera, depth)
    return mask


def _draw(
    mask: Bytes,
    start: Array,
    end: Array,
    radius: float,
    camera: Intrinsics,
    depth: Singles | None,
) -> None:
    ends = np.array([start, end])
    if not (np.isfinite(ends).all() and (ends[:, 2] > NEAREST_M).all()):
        return
    pixels = camera.project(ends)
    if np.abs(pixels).max() > 1e4:
        return
    nearest = float(ends[:, 2].min())
    thickness = max(1, round(2.0 * radius * camera.fx / nearest))
    covered = np.zeros_like(mask)
    first, last = np.rint(pixels).astype(int).tolist()
    cv2.line(covered, first, last, 1, min(thickness, 255))
    if depth is not None:
        behind = depth > float(ends[:, 2].max()) + SAME_DEPTH_M
        covered[behind | ((depth > 0.0) & (depth < nearest - SAME_DEPTH_M))] = 0
    np.maximum(mask, covered, out=mask)
