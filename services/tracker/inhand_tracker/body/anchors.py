"""Anchors: coordinate systems on the body that an object's pose is predicted in.

Darby et al. 2014 take each part's basis from the part's two joints: where these are near to each
other, as a hand and its wrist, their noise turns the basis. Anchors rest on joints that are far
apart. Some turn with a limb, others keep the trunk's directions at a limb's place, and one lies
between the hands.
"""

from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import JOINT_NAMES

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
    up = _unit(_joint(joints, "ShoulderCenter") - _joint(joints, "HipCenter"))
    left = _unit(_joint(joints, "ShoulderLeft") - _joint(joints, "ShoulderRight"))
    left = left + _unit(_joint(joints, "HipLeft") - _joint(joints, "HipRight"))
    x = _unit(left - np.sum(left * up, axis=-1, keepdims=True) * up)
    return np.stack([x, up, np.cross(x, up)], axis=-1)


def find_anchors(joints: Array) -> Anchors:
    """Find the anchors of joints (..., 20, 3)."""
    trunk = trunk_axes(joints)
    up, forwards = trunk[..., 1], trunk[..., 2]
    hips, chest = _joint(joints, "HipCenter"), _joint(joints, "ShoulderCenter")
    head = _joint(joints, "Head")
    right_palm, right_forearm = _forearm(joints, "Right", up)
    left_palm, left_forearm = _forearm(joints, "Left", up)
    between = left_palm - right_palm
    anchors = [
        (0.5 * (hips + chest), trunk),
        (head, _axes(head - chest, forwards)),
        (right_palm, right_forearm),
        (right_palm, trunk),
        (left_palm, left_forearm),
        (left_palm, trunk),
        (0.5 * (right_palm + left_palm), _axes(between, up)),
        _shank(joints, "Right", forwards),
        _shank(joints, "Left", forwards),
    ]
    return Anchors(
        np.stack([origin for origin, _ in anchors], axis=-2),
        np.stack([axes for _, axes in anchors], axis=-3),
    )


def _forearm(joints: Array, side: str, up: Array) -> tuple[Array, Array]:
    """The palm (..., 3), and axes whose z is the forearm and whose y is turned to its front."""
    elbow, wrist, hand = (_joint(joints, part + side) for part in ("Elbow", "Wrist", "Hand"))
    upper_arm = elbow - _joint(joints, "Shoulder" + side)
    along = wrist - elbow + 0.5 * (hand - wrist)
    return 0.5 * (wrist + hand), _axes(along, DEFAULT_BODY.straight_arm * up - upper_arm)


def _shank(joints: Array, side: str, forwards: Array) -> tuple[Array, Array]:
    """The ankle (..., 3), and axes whose z is the shank and whose y is turned forwards."""
    ankle = _joint(joints, "Ankle" + side)
    return ankle, _axes(_joint(joints, "Knee" + side) - ankle, forwards)


def _axes(z: Array, towards: Array) -> Array:
    """Columns with z along a direction (..., 3) and y as near to another as that allows."""
    z = _unit(z)
    x = _unit(np.cross(towards, z))
    return np.stack([x, np.cross(z, x), z], axis=-1)


def _joint(joints: Array, name: str) -> Array:
    return joints[..., JOINT_NAMES.index(name), :]


def _unit(vector: Array) -> Array:
    length: Array = np.linalg.norm(vector, axis=-1, keepdims=True)
    return vector / np.maximum(length, 1e-9)
