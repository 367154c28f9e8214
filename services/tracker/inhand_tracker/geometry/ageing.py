"""What stands of an estimate while the person is not seen."""

from dataclasses import replace

import numpy as np

from inhand_tracker.geometry.estimate import LOST, Estimate

COASTING_NS = 1_000_000_000
COASTING_SPEED = 0.5
COASTING_TURN_RATE = 2.0


def coasted(estimate: Estimate, unseen_ns: int) -> Estimate:
    """An estimate that is so old: predicted for a second, with growing covariance; then lost."""
    covariance = estimate.covariance
    if covariance is None or not 0 <= unseen_ns <= COASTING_NS:
        return LOST
    spread = np.repeat(np.square([COASTING_SPEED, COASTING_TURN_RATE]), 3)
    return replace(
        estimate,
        state="predicted",
        confidence=estimate.confidence * (1.0 - unseen_ns / COASTING_NS),
        covariance=covariance + np.diag(spread) * (unseen_ns / 1e9) ** 2,
    )
