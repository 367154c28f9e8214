"""Bins of pixels to scores for one object."""

import numpy as np
from inhand_runtime.compiled import njit
from numpy.typing import NDArray

from inhand_tracker.geometry.arrays import Bytes, Singles


@njit(cache=True, nogil=True)
def score_colours(
    bins: NDArray[np.uint16], limbs: Bytes, table: Singles, limb_share: float, scores: Singles
) -> None:
    """Fill ``scores`` (H, W, 2), for a pixel's being within and beside an object, from a table
    (4096, 2) by bins (H, W).

    Where ``limbs`` (H, W) may be, only a ``limb_share`` of what speaks against the object counts.
    """
    for row in range(bins.shape[0]):
        for column in range(bins.shape[1]):
            within, beside = table[bins[row, column]]
            if limbs[row, column] and within < beside:
                within, beside = within * limb_share, beside * limb_share
            scores[row, column, 0] = within
            scores[row, column, 1] = beside
