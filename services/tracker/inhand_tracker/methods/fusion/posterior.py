"""How likely poses are by one image and by what is believed beforehand; the likeliest of them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.geometry.bounding_sphere import BoundingSphere
from inhand_tracker.geometry.kernels.pose_normals import each_once, inverses
from inhand_tracker.geometry.pose_gaussian import (
    PoseGaussian,
    PoseMixture,
    means_of,
    mixture,
    moved_information,
    roots_of,
)
from inhand_tracker.methods.fusion.parameters import FusionParameters
from inhand_tracker.sight.refinement import PosePrior
from inhand_tracker.sight.sight import Sight
from inhand_tracker.sight.view import SightView


@dataclass(frozen=True)
class ImagePosterior:
    """One object's poses, judged by a view of an image and by a belief.

    The image counts by its ``sharpness``, from 0 to 1. Where the search is ``thorough``, poses are
    near the truth before they are refined.
    """

    sight: Sight
    sphere: BoundingSphere
    view: SightView
    belief: PoseMixture
    sharpness: float
    parameters: FusionParameters
    thorough: bool = False

    def scores(
        self, centres: Array, orientations: Array, *, quickly: bool = False
    ) -> tuple[Array, Array]:
        """Return the log-posterior (P,) of poses (P, 3) and (P, 4), up to a constant, and the
        image's log-likelihood in it, untempered, (P,); ``quickly`` as ``Sight.weigh``."""
        origins = self.sphere.origins(centres, orientations)
        weighed = self.sight.weigh(origins, orientations, self.view, quickly=quickly)
        return self.scores_by(weighed, centres, orientations)

    def scores_by(self, weighed: Array, centres: Array, orientations: Array) -> tuple[Array, Array]:
        """Return the ``scores`` of poses that ``Sight.weigh`` has weighed, (P, 5)."""
        seen = self.sight.log_likelihood_by(weighed, self.view)
        expected = self.belief.log_density(centres, orientations)
        return self._tempered(seen) + expected, seen

    def weigh(self, modes: Sequence[PoseGaussian], seen: Array) -> PoseMixture:
        """Weigh modes by their probability (Laplace's approximation); ``seen`` (K,) is the image's
        log-likelihood of each."""
        expected = self.belief.log_density(*means_of(modes))
        roots = roots_of(np.array([mode.covariance for mode in modes]))
        volumes = np.log(np.diagonal(roots, axis1=1, axis2=2)).sum(axis=1)
        return mixture(modes, self._tempered(seen) + expected + volumes)

    def modes(self, centres: Array, orientations: Array) -> tuple[list[PoseGaussian], Array]:
        """Find where image and belief agree best near each start (S, 3), (S, 4), each once; also
        the image's log-likelihood (K,) there."""
        nearest = np.argmax(self.belief.log_densities(centres, orientations), axis=0)
        order = np.argsort(nearest, kind="stable")
        starts, nearest = (centres[order], orientations[order]), nearest[order]
        if self.parameters.refines:
            return self._refined(*starts, nearest)
        covariances = np.array([part.covariance for part in self.belief.parts])[nearest]
        modes = list(map(PoseGaussian, *starts, covariances))
        return modes, self.scores(*starts)[1]

    def _refined(
        self, centres: Array, orientations: Array, nearest: Indices
    ) -> tuple[list[PoseGaussian], Array]:
        """Move poses to where the image and each's ``nearest`` (S,) part of the belief agree."""
        parts = self.belief.parts
        places, turns = self.belief.means
        arms = self.sphere.arm(turns)
        information = inverses(np.array([part.covariance for part in parts]))
        of_origins = moved_information(information, arms)
        refined = self.sight.refine(
            self.sphere.origins(centres, orientations),
            orientations,
            self.view,
            PosePrior(
                (places - arms)[nearest],
                turns[nearest],
                of_origins[nearest],
                self._most_off(),
            ),
            self.parameters.refinement_temper * self.sharpness,
        )
        arms = self.sphere.arm(refined.rotations)
        seen = moved_information(refined.information, -arms)
        covariances = inverses(information[nearest] + seen)
        means = refined.translations + arms, refined.rotations
        chosen = self._each_once(*means)
        modes = list(map(PoseGaussian, means[0][chosen], means[1][chosen], covariances[chosen]))
        return modes, refined.log_likelihoods[chosen]

    def _each_once(self, centres: Array, orientations: Array) -> Indices:
        """Choose poses (S, 3), (S, 4) of which none is the same as one before."""
        near = self.parameters.same_mode_m, self.parameters.same_mode_rad
        return np.flatnonzero(each_once(centres, orientations, *near))

    def _most_off(self) -> tuple[float, float]:
        """How far poses are off before they are refined, in metres and radians, at the most."""
        if not self.thorough:
            return np.inf, np.inf
        return self.parameters.narrowed_off_m, self.parameters.narrowed_off_rad

    def _tempered(self, seen: Array) -> Array:
        return self.parameters.image_temper * self.sharpness * seen
