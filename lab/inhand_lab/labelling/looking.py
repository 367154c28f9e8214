"""Finding where one frame's image and what was expected of it agree best."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.pose_normals import inverses
from inhand_tracker.geometry.pose_gaussian import PoseGaussian, PoseMixture, means_of, mixture
from inhand_tracker.sight.refinement import PosePrior, Refined
from inhand_tracker.sight.sight import Sight
from inhand_tracker.sight.view import SightView

from inhand_lab.labelling.parameters import LabellingParameters


@dataclass(frozen=True)
class Look:
    """One frame: what was ``expected`` without its image, what is ``believed`` with it, and the
    ``information`` (6, 6) that the image added; zeros where it says nothing."""

    expected: PoseGaussian
    believed: PoseGaussian
    information: Array


def unseen(expected: PoseGaussian) -> Look:
    """Return the look at a frame that has no image."""
    return Look(expected, expected, np.zeros((6, 6)))


@dataclass(frozen=True)
class Looker:
    """Looks for one object near where it is expected."""

    sight: Sight
    parameters: LabellingParameters

    def look(
        self,
        expected: Sequence[PoseGaussian],
        starts: Sequence[PoseGaussian],
        view: SightView | None,
        sharpness: float,
        random: np.random.Generator,
    ) -> Look:
        """Look near several expectations, the first of which counts where nothing is shown, and
        from other ``starts`` as well. A blurred image counts by its ``sharpness``, from 0 to 1."""
        if view is None:
            return unseen(expected[0])
        belief = mixture(expected, np.zeros(len(expected)))
        centres, turns = self._starts(belief, starts, view, sharpness, random)
        nearest = np.argmax(belief.log_densities(centres, turns), axis=0)
        means = belief.means
        information = inverses(np.array([one.covariance for one in expected]))
        prior = PosePrior(means[0][nearest], means[1][nearest], information[nearest])
        trust = sharpness * self.parameters.refinement_trust
        refined = self.sight.refine(centres, turns, view, prior, trust)
        poses = refined.translations, refined.rotations
        scores = sharpness * self.parameters.image_trust * refined.log_likelihoods
        best = int(np.argmax(scores + belief.log_density(*poses)))
        seen = self._information(refined, best)
        covariance = np.linalg.inv(information[nearest[best]] + seen)
        believed = PoseGaussian(poses[0][best], poses[1][best], covariance)
        return Look(expected[nearest[best]], believed, seen)

    def _information(self, refined: Refined, best: int) -> Array:
        """Return the image's information (6, 6) at the best pose, which has none of its own where
        it did not move: that of the likeliest other pose that came as near as makes no
        difference."""
        there = PoseGaussian(refined.translations[best], refined.rotations[best], np.eye(6))
        off = there.deviations(refined.translations, refined.rotations)
        near = (np.linalg.norm(off[:, :3], axis=1) < self.parameters.same_m) & (
            np.linalg.norm(off[:, 3:], axis=1) < self.parameters.same_rad
        )
        moved = np.flatnonzero(near & refined.information.any(axis=(1, 2)))
        if not len(moved):
            return np.zeros((6, 6))
        likeliest = moved[np.argmax(refined.log_likelihoods[moved])]
        return np.asarray(refined.information[best if best in moved else likeliest])

    def _starts(
        self,
        belief: PoseMixture,
        starts: Sequence[PoseGaussian],
        view: SightView,
        sharpness: float,
        random: np.random.Generator,
    ) -> tuple[Array, Array]:
        """Return what is expected, the ``starts``, and the likeliest of many poses around."""
        centres, turns = belief.sample(self.parameters.drawn, random)
        weighed = self.sight.weigh(centres, turns, view, quickly=True)
        seen = self.sight.log_likelihood_by(weighed, view)
        scores = sharpness * self.parameters.image_trust * seen + belief.log_density(centres, turns)
        best = np.argsort(-scores)[: self.parameters.refined]
        given = means_of([*belief.parts, *starts])
        return np.concatenate((given[0], centres[best])), np.concatenate((given[1], turns[best]))
