"""One skeleton of several: each joint where the cameras that see it best have it.

A joint errs more along the line of sight than across it, and now and then is far off. So it is the
mode of Student's t distributions of such covariances, about each camera's joint and about where the
joint was expected: found by weighing anew, from the median on (Lange, Little and Taylor 1989).
"""

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.rig.parameters import DEFAULT_RIG, RigParameters

_EYE = np.eye(3)


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
    there = np.asarray(np.isfinite(joints).all(axis=2))
    information = _information(deviations, rays, parameters.along_factor)
    points = np.where(there[..., None], joints, 0.0)
    if expected is not None:
        helps = np.asarray(np.isfinite(expected).all(axis=1) & (there.sum(axis=0) >= 2))
        by_past = np.broadcast_to(_EYE / parameters.expected_m**2, (1, len(expected), 3, 3))
        information = np.concatenate((information, by_past))
        points = np.concatenate((points, np.where(helps[:, None], expected, 0.0)[None]))
        there = np.concatenate((there, helps[None]))
    weights = there.astype(float)
    fused = np.full(points.shape[1:], np.nan)
    some = np.asarray(there.any(axis=0))
    if not some.any():
        return fused, np.zeros(joints.shape[:2])
    points, information = points[:, some], information[:, some]
    present = there[:, some]
    middle = np.nanmedian(np.where(present[..., None], points, np.nan), axis=0)
    for _ in range(parameters.reweightings):
        off = points - middle
        squares = np.einsum("cji,cjik,cjk->cj", off, information, off)
        sure = present * (parameters.freedom + 3.0) / (parameters.freedom + squares)
        weighted = sure[..., None, None] * information
        sums = weighted.sum(axis=0)
        middle = np.linalg.solve(sums, np.einsum("cjik,cjk->ji", weighted, points)[..., None])[
            ..., 0
        ]
    fused[some] = middle
    weights[:, some] = sure * parameters.freedom / (parameters.freedom + 3.0)
    return fused, weights[: len(joints)]


def _information(deviations: Array, rays: Array, along_factor: float) -> Array:
    """The inverse covariances (C, J, 3, 3) of joints; those without a ray have the same in all
    directions."""
    known = np.nan_to_num(rays)
    along = known[..., :, None] * known[..., None, :]
    less = 1.0 - 1.0 / along_factor**2
    return np.asarray((_EYE - less * along) / np.square(deviations)[..., None, None])
