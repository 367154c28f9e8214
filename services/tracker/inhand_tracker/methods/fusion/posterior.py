"""How likely poses are by a moment's images and by what is believed beforehand; the likeliest."""

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
from inhand_tracker.sight.refinement import PosePrior, Refined
from inhand_tracker.sight.sight import Sight
from inhand_tracker.sight.view import PlacedView


@dataclass(frozen=True)
class ImagePosterior:
    """One object's poses, judged by the views of one camera or several and by a belief.

    The images count by ``sharpness``, from 0 to 1, and each view by its own times that. Where the
    search is ``thorough``, poses are near the truth before they are refined. Several cameras show
    the object as ``shown`` whole sharp images do.
    """

    sight: Sight
    sphere: BoundingSphere
    views: tuple[PlacedView, ...]
    belief: PoseMixture
    sharpness: float
    parameters: FusionParameters
    thorough: bool = False
    shown: float = 1.0

    @property
    def unconvincing(self) -> float:
        """Log-likelihood below which the images do not support a pose: each that shows the object
        should."""
        return self.shown * self.parameters.unconvincing_log_likelihood

    def scores(
        self, centres: Array, orientations: Array, *, quickly: bool = False
    ) -> tuple[Array, Array]:
        """Return the log-posterior (P,) of poses (P, 3) and (P, 4), up to a constant, and the
        images' log-likelihood in it, untempered, (P,); ``quickly`` as ``Sight.weigh``."""
        return self.scores_by(
            self.weighed(centres, orientations, quickly=quickly), centres, orientations
        )

    def weighed(self, centres: Array, orientations: Array, *, quickly: bool = False) -> list[Array]:
        """Return what ``Sight.weigh`` finds of poses (P, 3) and (P, 4) in each view, (P, 5)."""
        origins = self.sphere.origins(centres, orientations)
        return [
            self.sight.weigh(*one.poses(origins, orientations), one.view, quickly=quickly)
            for one in self.views
        ]

    def scores_by(
        self, weighed: Sequence[Array], centres: Array, orientations: Array
    ) -> tuple[Array, Array]:
        """Return the ``scores`` of poses that were ``weighed`` in each view, (P, 5)."""
        each = [
            one.sharpness * self.sight.log_likelihood_by(scores, one.view)
            for one, scores in zip(self.views, weighed, strict=True)
        ]
        seen = sum(each[1:], each[0])
        expected = self.belief.log_density(centres, orientations)
        return self._tempered(seen) + expected, seen

    def weigh(self, modes: Sequence[PoseGaussian], seen: Array) -> PoseMixture:
        """Weigh modes by their probability (Laplace's approximation); ``seen`` (K,) is the images'
        log-likelihood of each."""
        expected = self.belief.log_density(*means_of(modes))
        roots = roots_of(np.array([mode.covariance for mode in modes]))
        volumes = np.log(np.diagonal(roots, axis1=1, axis2=2)).sum(axis=1)
        return mixture(modes, self._tempered(seen) + expected + volumes)

    def modes(self, centres: Array, orientations: Array) -> tuple[list[PoseGaussian], Array]:
        """Find where image and belief agree best near each start (S, 3), (S, 4), each once; also
        the images' log-likelihood (K,) there."""
        nearest = np.argmax(self.belief.log_densities(centres, orientations), axis=0)
        order = np.argsort(nearest, kind="stable")
        starts, nearest = (centres[order], orientations[order]), nearest[order]
        if self.parameters.refines:
            modes, seen = self._refined(*starts, nearest)
            if self.thorough and len(self.views) > 1:
                return self._with_likelier(*starts, modes, seen)
            return modes, seen
        covariances = np.array([part.covariance for part in self.belief.parts])[nearest]
        modes = list(map(PoseGaussian, *starts, covariances))
        return modes, self.scores(*starts)[1]

    def _with_likelier(
        self, centres: Array, orientations: Array, modes: list[PoseGaussian], seen: Array
    ) -> tuple[list[PoseGaussian], Array]:
        """Add the likeliest start to the modes, where refinement, which trusts the images less,
        has left all of them less likely: as unsure as the nearest mode is."""
        scores, seen_there = self.scores(centres, orientations)
        means = means_of(modes)
        best = int(np.argmax(scores))
        if scores[best] <= (self._tempered(seen) + self.belief.log_density(*means)).max():
            return modes, seen
        nearest = int(np.argmin(np.linalg.norm(means[0] - centres[best], axis=1)))
        start = PoseGaussian(centres[best], orientations[best], modes[nearest].covariance)
        return [*modes, start], np.append(seen, seen_there[best])

    def _refined(
        self, centres: Array, orientations: Array, nearest: Indices
    ) -> tuple[list[PoseGaussian], Array]:
        """Move poses to where the image and each's ``nearest`` (S,) part of the belief agree."""
        parts = self.belief.parts
        places, turns = self.belief.means
        arms = self.sphere.arm(turns)
        information = inverses(np.array([part.covariance for part in parts]))
        of_origins = moved_information(information, arms)
        refined, kept = self._refine(
            self.sphere.origins(centres, orientations),
            orientations,
            PosePrior(
                (places - arms)[nearest],
                turns[nearest],
                of_origins[nearest],
                self._most_off(),
            ),
        )
        nearest = nearest[kept]
        arms = self.sphere.arm(refined.rotations)
        seen = moved_information(refined.information, -arms)
        covariances = inverses(information[nearest] + seen)
        means = refined.translations + arms, refined.rotations
        chosen = self._each_once(*means)
        modes = list(map(PoseGaussian, means[0][chosen], means[1][chosen], covariances[chosen]))
        return modes, refined.log_likelihoods[chosen]

    def _refine(
        self, origins: Array, orientations: Array, prior: PosePrior
    ) -> tuple[Refined, Indices]:
        """Refine poses (S, 3) and (S, 4) of the object's origin; also the indices of those that
        are left."""
        trust = self.parameters.refinement_temper * self.sharpness
        poses, views = (origins, orientations), self.views
        if len(views) == 1 and views[0].view_from_reference is None:
            refined = self.sight.refine(*poses, views[0].view, prior, trust)
            return refined, np.arange(len(origins))
        near = self.parameters.same_mode_m, self.parameters.same_mode_rad
        return self.sight.refine_together(*poses, views, prior, trust, near)

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
