"""Anchors: coordinate systems on the body that an object's pose is predicted in.

Darby et al. 2014 take each part's basis from the part's two joints: where these are near to each
other, as a hand and its wrist, their noise turns the basis. Anchors rest on joints that are far
apart. Some turn with a limb, others keep the trunk's directions at a limb's place, and one lies
between the hands.
"""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.body.kernels import axes as kernels
from inhand_tracker.body.parameters import DEFAULT_BODY
from inhand_tracker.geometry.arrays import Array

ANCHORS = (
    "trunk",
    "head",
    "right forearm",
    "right hand",
    "left forearm",
    "left hand",
    "hands",
    "right shank",
    "left shank",
)
"""Names of the anchors, in their order."""


@dataclass(frozen=True)
class Anchors:
    """Coordinate systems in the joints' frame: ``origins`` (..., A, 3), ``axes`` (..., A, 3, 3).

    Axes are columns.
    """

    origins: Array
    axes: Array


def trunk_axes(joints: Array) -> Array:
    """Find the trunk's left, up and forwards, columns (..., 3, 3), of joints (..., 20, 3)."""
    return kernels.trunk(joints)


def find_anchors(joints: Array) -> Anchors:
    """Find the anchors of joints (..., 20, 3)."""
    return Anchors(*kernels.anchors(joints, DEFAULT_BODY.straight_arm, _NINE))


_NINE = np.zeros(len(ANCHORS))
"""It tells the kernel how many anchors there are."""
