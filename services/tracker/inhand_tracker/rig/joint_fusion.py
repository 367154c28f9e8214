"""One skeleton of several: each joint where the cameras that see it best have it.

A joint errs more along the line of sight than across it, and now and then is far off. So it is the
mode of Student's t distributions of such covariances, about each camera's joint and about where the
joint was expected: found by weighing anew, from the median on (Lange, Little and Taylor 1989).
"""

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.rig.kernels.fuse import FuseSettings, fuse
from inhand_tracker.rig.parameters import DEFAULT_RIG, RigParameters


def fuse_joints(
    joints: Array,
    deviations: Array,
    rays: Array,
    expected: Array | None = None,
    parameters: RigParameters = DEFAULT_RIG,
) -> tuple[Array, Array]:
    """Fuse joints (C, J, 3) of C cameras, missing ones NaN, to (J, 3), NaN where none has one.

    ``deviations`` (C, J) are across the lines of sight ``rays`` (C, J, 3), in metres; ``expected``
    (J, 3) is where joints should be, NaN where that is not known: it only helps where two or more
    cameras see a joint, to choose. Also returns the weights (C, J) that cameras had, from 0 to 1.
    """
    count = joints.shape[1]
    if expected is None:
        expected = np.full((count, 3), np.nan)
    fused, weights = np.empty((count, 3)), np.empty(joints.shape[:2])
    settings = FuseSettings(
        parameters.along_factor,
        parameters.freedom,
        parameters.reweightings,
        parameters.expected_m,
    )
    fuse(joints, deviations, rays, expected, settings, fused, weights)
    return fused, weights
