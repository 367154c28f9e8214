"""Holders: what may hold an object, or wear it, and how that turns with the body.

An object in a fist turns with the forearm, whatever the body does, and one that is kept upright has
the trunk's directions at the palm.
"""

from dataclasses import dataclass

from inhand_tracker.body.anchors import ANCHORS, Anchors
from inhand_tracker.geometry.arrays import Array


@dataclass(frozen=True)
class Holder:
    """A part of the body by the name of its anchor; ``other`` is that of the other hand, which may
    hold the object as well, and ``upright`` whether directions are the trunk's."""

    anchor: str
    other: str | None = None
    upright: bool = False


HOLDERS = (
    Holder("right forearm", other="left forearm"),
    Holder("left forearm", other="right forearm"),
    Holder("head"),
    Holder("right shank"),
    Holder("left shank"),
    Holder("right hand", upright=True),
    Holder("left hand", upright=True),
)
"""The holders, the dominant hand first."""
_ANCHORS = tuple(ANCHORS.index(holder.anchor) for holder in HOLDERS)
_OTHERS = tuple(ANCHORS.index(holder.other or holder.anchor) for holder in HOLDERS)


def find_holder(anchors: Anchors, holder: int) -> tuple[Array, Array, Array]:
    """Find the origins (..., 3) and axes (..., 3, 3), columns, of the holder of a number, and the
    way (..., 3) from it to the other hand: 0 where that is none of its matters."""
    anchor, other = _ANCHORS[holder], _OTHERS[holder]
    origins = anchors.origins[..., anchor, :]
    return origins, anchors.axes[..., anchor, :, :], anchors.origins[..., other, :] - origins
