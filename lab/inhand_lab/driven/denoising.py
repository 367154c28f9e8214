"""The body behind a tracker's joints: near what was recorded, smooth, and of constant bones.

Three steps. Each joint's path is smoothed robustly (Whittaker's smoother: weighted least squares
with a penalty on the third difference; Eilers, Analytical Chemistry 75, 2003), where frames count
little in which the joint has left its bone or lies far from its own path. Each bone then has its
median length, the same on both sides, and the joints are moved to keep it and to keep elbows from
bending too far (position-based dynamics; Mueller et al., 2007).

The result is a body that could have moved so, not the body that did: errors of the tracker that
last longer than about a fifth of a second stay in it.
"""

from __future__ import annotations

import numpy as np
from inhand_schemas.joints import MIRRORED_JOINTS, PARENTS, Joint
from inhand_tracker.geometry.arrays import Array
from scipy.linalg import solveh_banded

from inhand_lab.driven.parameters import DEFAULT_DENOISING, DenoisingParameters
from inhand_lab.people.parameters import DEFAULT_LIMITS
from inhand_lab.people.two_bones import span

CHILDREN = list(range(1, len(PARENTS)))
ROOTS = list(PARENTS[1:])
ARMS = (
    (Joint.SHOULDER_RIGHT, Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT),
    (Joint.SHOULDER_LEFT, Joint.ELBOW_LEFT, Joint.WRIST_LEFT),
)


def denoise(
    joints: Array, frame_rate: float, parameters: DenoisingParameters = DEFAULT_DENOISING
) -> Array:
    """Plausible true joints (T, 20, 3) of measured ones (T, 20, 3), NaN where one is missing.

    Every joint must have been seen at least once.
    """
    trust = _trust_in_bones(joints, parameters)
    smooth = _smooth_paths(joints, trust, frame_rate, parameters)
    return _keep_bones(smooth, bone_lengths(smooth), parameters.relaxations)


def bone_lengths(joints: Array) -> Array:
    """Median length (19,) of the bone that ends at each joint but the first, of both sides."""
    lengths = _lengths(joints)
    mirrored = np.array(MIRRORED_JOINTS[1:]) - 1
    return np.asarray(np.nanmedian(np.concatenate([lengths, lengths[:, mirrored]]), axis=0))


def _lengths(joints: Array) -> Array:
    return np.asarray(np.linalg.norm(joints[:, CHILDREN] - joints[:, ROOTS], axis=2))


def _trust_in_bones(joints: Array, parameters: DenoisingParameters) -> Array:
    """Weights (T, 20), small for a joint too near to or far from its parent, 0 if missing."""
    weights = np.isfinite(joints).all(axis=2).astype(float)
    usual = bone_lengths(joints)
    with np.errstate(invalid="ignore"):
        strange = (_lengths(joints) / usual - 1.0) / parameters.bone_deviation
    weights[:, 1:] /= 1.0 + np.nan_to_num(strange) ** 2
    return weights


def _smooth_paths(
    joints: Array, trust: Array, frame_rate: float, parameters: DenoisingParameters
) -> Array:
    """Paths (T, 20, 3) smoothed again and again, with less weight for what is far from them."""
    observed = np.nan_to_num(joints)
    smooth = np.empty_like(observed)
    for joint in range(observed.shape[1]):
        weights = trust[:, joint]
        for _ in range(parameters.reweightings):
            smooth[:, joint] = smooth_path(
                observed[:, joint], weights, parameters.cut_off / frame_rate
            )
            away = np.linalg.norm(observed[:, joint] - smooth[:, joint], axis=1)
            weights = trust[:, joint] / (1.0 + (away / parameters.path_deviation) ** 2)
    return smooth


def smooth_path(path: Array, weights: Array, cut_off: float) -> Array:
    """The path (T, K) that minimises weighted squared distances plus squared third differences.

    Half of a movement is kept at the cut-off, a share of the frame rate. ``weights`` (T,) are from
    0 to 1, not all 0.
    """
    count = len(path)
    if count < 4:
        return np.tile(np.average(path, axis=0, weights=weights), (count, 1))
    stiffness = (2.0 * np.sin(np.pi * min(cut_off, 0.5))) ** -6.0
    difference = np.diff(np.eye(4), 3, axis=0)[0]
    banded = np.zeros((4, count))
    for first in range(4):
        for second in range(first, 4):
            product = stiffness * difference[first] * difference[second]
            banded[second - first, first : count - 3 + first] += product
    banded[0] += weights + DEFAULT_DENOISING.least_weight
    return np.asarray(solveh_banded(banded, weights[:, None] * path, lower=True))


def _keep_bones(joints: Array, lengths: Array, relaxations: int) -> Array:
    """Joints (T, 20, 3) moved as little as it takes to give each bone its length (19,)."""
    kept = joints.copy()
    for _ in range(relaxations):
        for child, parent, length in zip(CHILDREN, ROOTS, lengths, strict=True):
            _pull(kept, parent, child, length, length)
        for shoulder, elbow, wrist in ARMS:
            reach = span(lengths[elbow - 1], lengths[wrist - 1], DEFAULT_LIMITS.flexion)
            _pull(kept, shoulder, wrist, reach, np.inf)
    return _hang_from_hips(kept, lengths)


def _pull(joints: Array, one: int, other: int, least: float, most: float) -> None:
    """Move two joints by equal ways to a distance between least and most, metres."""
    offset = joints[:, other] - joints[:, one]
    distance = np.linalg.norm(offset, axis=1, keepdims=True)
    wanted = np.clip(distance, least, most)
    way = 0.5 * offset * (wanted / np.maximum(distance, 1e-6) - 1.0)
    joints[:, one] -= way
    joints[:, other] += way


def _hang_from_hips(joints: Array, lengths: Array) -> Array:
    """Joints (T, 20, 3) on bones of exact length in the directions they have, no elbow too bent."""
    exact = joints.copy()
    directions = joints[:, CHILDREN] - joints[:, ROOTS]
    directions /= np.maximum(np.linalg.norm(directions, axis=2, keepdims=True), 1e-6)
    for _, elbow, wrist in ARMS:
        directions[:, wrist - 1] = _limited(directions[:, elbow - 1], directions[:, wrist - 1])
    for child, parent in zip(CHILDREN, ROOTS, strict=True):
        exact[:, child] = exact[:, parent] + lengths[child - 1] * directions[:, child - 1]
    return exact


def _limited(upper: Array, lower: Array) -> Array:
    """The lower bone's direction (T, 3), turned as far as its angle to the upper one allows."""
    cosine = np.sum(upper * lower, axis=1, keepdims=True)
    aside = lower - cosine * upper
    aside /= np.maximum(np.linalg.norm(aside, axis=1, keepdims=True), 1e-6)
    bend = np.minimum(np.arccos(np.clip(cosine, -1.0, 1.0)), np.pi - DEFAULT_LIMITS.flexion)
    return np.asarray(np.cos(bend) * upper + np.sin(bend) * aside)
