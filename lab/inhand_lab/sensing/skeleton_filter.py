"""The filter that comes with Kinect's skeletons: double exponential, and blind to small trembling.

Holt's method as Microsoft's Kinect SDK 1.x publishes it (Azimi, *Skeletal Joint Smoothing White
Paper*, 2012), with its usual settings. Within JITTER_RADIUS it follows the more reluctantly the
smaller the deviation is, so that a person who rests hardly trembles while a leap passes at once.
"""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

SMOOTHING = 0.5
CORRECTION = 0.5
PREDICTION = 0.5
JITTER_RADIUS = 0.05
"""Metres; twice as much for a joint that is inferred, as is DEVIATION_RADIUS."""
DEVIATION_RADIUS = 0.04
"""How far, in metres, the filtered joint may be from the measured one."""


def smooth(joints: Array, guessed: Array) -> Array:
    """Filtered joints (T, J, 3) of measured ones, in metres; guessed (T, J), 0 to 1, tells where
    they are inferred."""
    smoothed = joints.copy()
    level, trend = joints[0], np.zeros_like(joints[0])
    for frame, measured in enumerate(joints[1:], start=1):
        width = 1.0 + guessed[frame, :, None]
        trust = _distance(measured, level) / (JITTER_RADIUS * width)
        followed = level + (measured - level) * np.minimum(trust, 1.0)
        before = level
        level = (1.0 - SMOOTHING) * followed + SMOOTHING * (before + trend)
        trend = CORRECTION * (level - before) + (1.0 - CORRECTION) * trend
        predicted = level + PREDICTION * trend
        allowed = DEVIATION_RADIUS * width
        share = allowed / np.maximum(_distance(predicted, measured), allowed)
        smoothed[frame] = measured + share * (predicted - measured)
    return smoothed


def _distance(points: Array, others: Array) -> Array:
    return np.asarray(np.linalg.norm(points - others, axis=-1, keepdims=True))
