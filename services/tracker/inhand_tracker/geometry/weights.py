"""Weights of particles, hypotheses and parts of a mixture: arrays that sum to 1."""

import numpy as np

from inhand_tracker.geometry.arrays import Array, Indices


def even_weights(count: int) -> Array:
    """Equal weights (P,)."""
    return np.full(count, 1.0 / count)


def normalised_weights(log_weights: Array) -> Array:
    """Weights (P,) of logarithms that are known up to a constant."""
    weights = np.exp(log_weights - log_weights.max())
    return weights / weights.sum()


def systematic_resample(weights: Array, random: np.random.Generator) -> Indices:
    """Indices (P,) of the particles that survive, in proportion to their weights."""
    positions = (random.random() + np.arange(len(weights))) / len(weights)
    positions = np.minimum(positions, np.nextafter(1.0, 0.0))  # rounding may give 1
    cumulative = np.cumsum(weights)
    return np.searchsorted(cumulative / cumulative[-1], positions, side="right")
