"""Coordinate systems of what holds an object, by kernels, from the anchors of one body."""

import numpy as np
from inhand_runtime.compiled import njit, vectorised

from inhand_tracker.body.anchors import ANCHORS
from inhand_tracker.body.kernels.axes import set_axes
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.quaternions import vector_in
from inhand_tracker.geometry.kernels.vectors import blended, minus

OF_A_HAND = 3
"""Number of holders that turn with either hand."""
FOREARMS = tuple(ANCHORS.index(name) for name in ("right forearm", "left forearm"))
OTHERS = tuple(
    ANCHORS.index(name) for name in ("head", "right shank", "left shank", "right hand", "left hand")
)
"""Anchors of the other holders; hands keep the trunk's directions."""


@njit(cache=True, nogil=True)
def set_holder(
    origins: Array, axes: Array, holder: int, hands_together_m: float, origin: Array, own: Array
) -> None:
    """Fill the ``origin`` (3,) and axes ``own`` (3, 3), columns, of the holder of a number, by
    anchors' origins (A, 3) and axes (A, 3, 3)."""
    if holder >= 2 * OF_A_HAND:
        anchor = OTHERS[holder - 2 * OF_A_HAND]
    else:
        anchor = FOREARMS[holder // OF_A_HAND]
    origin[:] = origins[anchor]
    own[:] = axes[anchor]
    kind = holder % OF_A_HAND
    if holder >= 2 * OF_A_HAND or kind == 0:
        return
    # Hands that touch, or arms that point at each other, leave the forearm's own front.
    other = FOREARMS[1 - holder // OF_A_HAND]
    front = own[0, 1], own[1, 1], own[2, 1]
    way = minus(vector_in(origins[other]), vector_in(origin))
    way = blended(way, hands_together_m, front)
    forearm = own[0, 2], own[1, 2], own[2, 2]
    if kind == 1:
        set_axes(own, forearm, way)
    else:
        set_axes(own, way, forearm)


@vectorised("(a,v),(a,v,v),(),()->(v),(v,v)")
def holders(
    origins: Array,
    axes: Array,
    holder: float,
    hands_together_m: float,
    origin: Array,
    own: Array,
) -> None:
    """Fill the ``origin`` (3,) and axes ``own`` (3, 3) of the holder of a number."""
    set_holder(origins, axes, np.int64(holder), hands_together_m, origin, own)
