"""The filter that comes with Kinect's skeletons: double exponential, and blind to small trembling.

Holt's method as Microsoft's Kinect SDK 1.x publishes it (Azimi, *Skeletal Joint Smoothing White
Paper*, 2012), with its usual settings. Within its jitter radius it follows the more reluctantly the
smaller the deviation is, so that a person who rests hardly trembles while a leap passes at once.
"""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.sensing.skeleton_noise_parameters import SkeletonFilter


def smooth(joints: Array, guessed: Array, settings: SkeletonFilter) -> Array:
    """Filtered joints (T, J, 3) of measured ones, in metres.

    ``guessed`` (T, J), 0 to 1, is how far a joint is inferred.
    """
    smoothing, correction = settings.smoothing, settings.correction
    smoothed = joints.copy()
    level, trend = joints[0], np.zeros_like(joints[0])
    for frame, measured in enumerate(joints[1:], start=1):
        width = 1.0 + guessed[frame, :, None]
        trust = _distance(measured, level) / (settings.jitter_radius * width)
        followed = level + (measured - level) * np.minimum(trust, 1.0)
        before = level
        level = (1.0 - smoothing) * followed + smoothing * (before + trend)
        trend = correction * (level - before) + (1.0 - correction) * trend
        predicted = level + settings.prediction * trend
        allowed = settings.deviation_radius * width
        share = allowed / np.maximum(_distance(predicted, measured), allowed)
        smoothed[frame] = measured + share * (predicted - measured)
    return smoothed


def _distance(points: Array, others: Array) -> Array:
    return np.asarray(np.linalg.norm(points - others, axis=-1, keepdims=True))
