"""Where in an image the person's forearms and hands may cover an object."""

import numpy as np
from inhand_schemas.joints import JOINT_NAMES

from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.sight.kernels.mark_limbs import LimbSizes, mark_limbs
from inhand_tracker.sight.parameters import DEFAULT_SIGHT, SightParameters

_ARMS = np.array(
    [
        [JOINT_NAMES.index(joint + side) for joint in ("Elbow", "Wrist", "Hand")]
        for side in ("Left", "Right")
    ]
)


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
    sizes = LimbSizes(
        parameters.forearm_m, parameters.hand_m, parameters.fingers_m, parameters.limb_depth_m
    )
    mark_limbs(np.asarray(joints, np.float64), _ARMS, camera.lens, sizes, depth, mask)
    return mask
