"""Holders: coordinate systems that turn with what may hold an object, or wear it.

An object in a fist turns with the forearm, and one in both hands with the line between them as
well, whatever the body does. One that is kept upright has the trunk's directions at the palm.
"""

from inhand_tracker.body.anchors import Anchors
from inhand_tracker.body.kernels import holders as kernels
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
UPRIGHT = 9
"""Number of the first holder that keeps the trunk's directions."""


def find_holder(anchors: Anchors, holder: int) -> tuple[Array, Array]:
    """Find the origins (..., 3) and axes (..., 3, 3), columns, of the holder of a number.

    Axes of a body whose joints lie on top of each other may have no length.
    """
    found: tuple[Array, Array] = kernels.holders(
        anchors.origins, anchors.axes, holder, DEFAULT_BODY.hands_together_m
    )
    return found
