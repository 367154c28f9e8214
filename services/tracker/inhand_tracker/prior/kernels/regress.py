"""Kernel regression of one input: its kernel to landmarks, and what that predicts."""

import numpy as np

from inhand_tracker.geometry.arrays import Array, Singles
from inhand_tracker.geometry.kernels.compiled import compiled


@compiled("(d),(l,d),()->(l)", singles=[0, 1])
def gaussian_of_one(one: Singles, landmarks: Singles, width: float, kernel: Array) -> None:
    """Fill ``kernel`` (L,) with exp(−d²/(2 width)) of the distances of (D,) from landmarks."""
    for landmark in range(len(landmarks)):
        square = 0.0
        for index in range(len(one)):
            off = np.float64(one[index]) - np.float64(landmarks[landmark, index])
            square += off * off
        kernel[landmark] = np.exp(square / (-2.0 * width))


@compiled("(l),(l,m),(m)->(m)")
def predicted_by(kernel: Array, coefficients: Array, offset: Array, predicted: Array) -> None:
    """Fill ``predicted`` (M,) with offset + kernel @ coefficients."""
    predicted[:] = offset
    for landmark in range(len(kernel)):
        for index in range(len(offset)):
            predicted[index] += kernel[landmark] * coefficients[landmark, index]
