"""Calibration: how much a covariance must grow to hold nine in ten held-out errors."""

import numpy as np
from scipy.special import ndtri, stdtrit

from inhand_tracker.geometry.arrays import Array

CHI_SQUARE_90 = 10.645
"""Square of the radius of a normal distribution's 90 % region in six dimensions."""


def widening_of(units: int) -> float:
    """The share by which a covariance is ``widened`` (combination) that a number of people tell."""
    return 1.0 / units**2


def calibration_of(covariances: Array, errors: Array, people: int) -> float:
    """The factor on covariances (L, 6, 6) by which they hold nine in ten errors (L, 6).

    A few people say less of the next one than it seems, as Student's t has it: one person's errors
    go together.
    """
    solved = np.linalg.solve(covariances, errors[..., None])[..., 0]
    of_these = np.quantile(np.einsum("li,li->l", errors, solved), 0.9) / CHI_SQUARE_90
    return float(of_these * np.square(stdtrit(people, 0.95) / ndtri(0.95)))
