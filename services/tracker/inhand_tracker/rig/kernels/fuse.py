"""Joints of several cameras as one, and how far joints are from each other."""

from typing import NamedTuple

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.matrices import find_root, solve


class FuseSettings(NamedTuple):
    """Numbers of ``RigParameters``, by those names."""

    along_factor: float
    freedom: float
    reweightings: int
    expected_m: float


@njit(cache=True, nogil=True)
def fuse(
    joints: Array,
    deviations: Array,
    rays: Array,
    expected: Array,
    settings: FuseSettings,
    fused: Array,
    weights: Array,
) -> None:
    """Fill ``fused`` (J, 3) and ``weights`` (C, J) by joints (C, J, 3) with ``deviations`` (C, J)
    across ``rays`` (C, J, 3), and by where they are ``expected`` (J, 3); what is missing is NaN."""
    cameras, count = joints.shape[0], joints.shape[1]
    points = np.empty((cameras + 1, 3))
    middle, root, off = np.empty(3), np.empty((3, 3)), np.empty(3)
    for joint in range(count):
        seen = 0
        for camera in range(cameras):
            weights[camera, joint] = 0.0
            if np.isfinite(joints[camera, joint]).all():
                points[seen] = joints[camera, joint]
                seen += 1
        fused[joint] = np.nan
        if seen == 0:
            continue
        helps = seen > 1 and np.isfinite(expected[joint]).all()
        if helps:
            points[seen] = expected[joint]
        for axis in range(3):
            middle[axis] = np.median(points[: seen + helps, axis])
        for _ in range(settings.reweightings):
            root[:], off[:] = 0.0, 0.0
            if helps:
                _add(
                    expected[joint],
                    np.zeros(3),
                    settings.expected_m,
                    settings,
                    middle,
                    root,
                    off,
                )
            for camera in range(cameras):
                if np.isfinite(joints[camera, joint]).all():
                    weights[camera, joint] = _add(
                        joints[camera, joint],
                        rays[camera, joint],
                        deviations[camera, joint],
                        settings,
                        middle,
                        root,
                        off,
                    )
            if find_root(root, root):
                solve(root, off)
                middle += off
        fused[joint] = middle


@njit(cache=True, nogil=True)
def _add(
    point: Array,
    ray: Array,
    deviation: float,
    settings: FuseSettings,
    middle: Array,
    information: Array,
    gradient: Array,
) -> float:
    """Add what a point says to the equation of a step from the ``middle`` (3,), and return its
    weight, from 0 to 1, by how far it is from there."""
    less = 1.0 - 1.0 / (settings.along_factor * settings.along_factor)
    certainty = 1.0 / (deviation * deviation)
    along = 0.0
    for axis in range(3):
        along += (point[axis] - middle[axis]) * ray[axis]
    square = 0.0
    for axis in range(3):
        square += (point[axis] - middle[axis]) ** 2
    square = certainty * (square - less * along * along)
    weight = settings.freedom / (settings.freedom + square)
    sure = weight * certainty * (settings.freedom + 3.0) / settings.freedom
    for row in range(3):
        gradient[row] += sure * (point[row] - middle[row] - less * along * ray[row])
        for column in range(3):
            information[row, column] -= sure * less * ray[row] * ray[column]
        information[row, row] += sure
    return weight


@njit(cache=True, nogil=True)
def mean_distance(one: Array, other: Array, order: Array) -> float:
    """Return the mean distance, in metres, of joints (J, 3), taken in an ``order`` (J,), from
    others that both have; infinite without."""
    whole, count = 0.0, 0
    for joint in range(len(one)):
        square = 0.0
        for axis in range(3):
            square += (one[order[joint], axis] - other[joint, axis]) ** 2
        if np.isfinite(square):
            whole += np.sqrt(square)
            count += 1
    return whole / count if count > 0 else np.inf
