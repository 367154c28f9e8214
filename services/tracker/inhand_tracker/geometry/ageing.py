"""How an estimate ages while the person is out of view, and when its object is declared lost."""

from dataclasses import replace

import numpy as np

from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.geometry.parameters import DEFAULT_AGEING, AgeingParameters


def aged(
    estimate: Estimate, unseen_ns: int, parameters: AgeingParameters = DEFAULT_AGEING
) -> Estimate:
    """Age an estimate whose person has been out of view for ``unseen_ns``.

    At first the pose stands as predicted, with less confidence and a wider covariance every
    moment; after a second the object is lost, and so it is when the clock went back.
    """
    covariance = estimate.covariance
    if covariance is None or not 0 <= unseen_ns <= parameters.lost_after_ns:
        return LOST
    rates = np.repeat([parameters.speed_m_s, parameters.turn_rate_rad_s], 3)
    return replace(
        estimate,
        state="predicted",
        confidence=estimate.confidence * (1.0 - unseen_ns / parameters.lost_after_ns),
        covariance=covariance + np.diag(np.square(rates)) * (unseen_ns / 1e9) ** 2,
    )
