"""Holders: coordinate systems that turn with what may hold an object, or wear it.

An object in a fist turns with the forearm, and one in both hands with the line between them as
well, whatever the body does. One that is kept upright has the trunk's directions at the palm.
"""

import numpy as np

from inhand_tracker.body.anchors import ANCHORS, Anchors
from inhand_tracker.body.parameters import DEFAULT_BODY
from inhand_tracker.geometry.arrays import Array

HOLDERS = (
    "right forearm",
    "right forearm, its front to the left hand",
    "way from the right hand to the left",
    "left forearm",
    "left forearm, its front to the right hand",
    "way from the left hand to the right",
    "head",
    "right shank",
    "left shank",
    "right palm, in the trunk's directions",
    "left palm, in the trunk's directions",
)
"""Names of the holders, in their order: three of the dominant hand, three of the other one, those
of what wears things, and those of what is kept upright."""
OF_A_HAND = 3
"""Number of holders that turn with either hand."""
UPRIGHT = 9
"""Number of the first holder that keeps the trunk's directions."""

_RIGHT, _LEFT, *_OTHERS = (
    ANCHORS.index(name)
    for name in (
        "right forearm",
        "left forearm",
        "head",
        "right shank",
        "left shank",
        "right hand",
        "left hand",
    )
)


def find_holder(anchors: Anchors, holder: int) -> tuple[Array, Array]:
    """Find the origins (..., 3) and axes (..., 3, 3), columns, of the holder of a number.

    Axes of a body whose joints lie on top of each other may have no length.
    """
    if holder >= 2 * OF_A_HAND:
        anchor = _OTHERS[holder - 2 * OF_A_HAND]
        return anchors.origins[..., anchor, :], anchors.axes[..., anchor, :, :]
    hand, other = (_RIGHT, _LEFT) if holder < OF_A_HAND else (_LEFT, _RIGHT)
    origins, own = anchors.origins[..., hand, :], anchors.axes[..., hand, :, :]
    kind = holder % OF_A_HAND
    if kind == 0:
        return origins, own
    # Hands that touch, or arms that point at each other, leave the forearm's own front.
    aside = DEFAULT_BODY.hands_together_m * own[..., :, 1]
    way = anchors.origins[..., other, :] - origins + aside
    forearm = own[..., :, 2]
    return origins, _axes(forearm, way) if kind == 1 else _axes(way, forearm)


def _axes(along: Array, towards: Array) -> Array:
    """Axes (..., 3, 3) with z along directions (..., 3) and y as near to others as that allows."""
    z = _unit(along)
    x = _unit(np.cross(towards, z))
    return np.stack((x, np.cross(z, x), z), axis=-1)


def _unit(vectors: Array) -> Array:
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.maximum(lengths, 1e-9))
