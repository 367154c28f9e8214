"""Narrowing a search down: hypotheses about the likeliest ones so far, ever closer to them.

Where a body says little of an object, hypotheses of what is believed all lie far from the truth, in
six dimensions, however many there are (annealing, as of Deutscher and Reid 2005).
"""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.pose_gaussian import draw_about
from inhand_tracker.methods.fusion.posterior import ImagePosterior


@dataclass(frozen=True)
class Hypotheses:
    """Poses of an object's pivot, ``centres`` (P, 3) and ``orientations`` (P, 4), with their
    log-posterior ``scores`` (P,)."""

    centres: Array
    orientations: Array
    scores: Array

    def best(self, count: int) -> "Hypotheses":
        """Return the likeliest, in no order."""
        chosen = np.argpartition(self.scores, -count)[-count:]
        return Hypotheses(self.centres[chosen], self.orientations[chosen], self.scores[chosen])


def narrow(
    posterior: ImagePosterior,
    first: Hypotheses,
    random: np.random.Generator,
) -> Hypotheses:
    """Add hypotheses about the best so far: in each round they scatter less."""
    parameters, belief = posterior.parameters, posterior.belief
    every = first
    for number in range(parameters.narrowing_rounds):
        share = parameters.narrowing_share / 2**number
        best = every.best(min(parameters.narrowed_best, len(every.scores)))
        count = parameters.narrowed_hypotheses
        about = np.resize(np.arange(len(best.scores)), count)
        nearest = np.argmax(belief.log_densities(best.centres, best.orientations), axis=0)
        centres, orientations = draw_about(
            (best.centres[about], best.orientations[about]),
            share * belief.roots[nearest[about]],
            random,
        )
        scores, _ = posterior.scores(centres, orientations, quickly=True)
        every = Hypotheses(
            np.concatenate((every.centres, centres)),
            np.concatenate((every.orientations, orientations)),
            np.concatenate((every.scores, scores)),
        )
    return every
