"""How likely poses are by one image and by what is believed beforehand; the likeliest of them."""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.bounding_sphere import BoundingSphere
from inhand_tracker.geometry.pose_gaussian import PoseGaussian, PoseMixture, lever, mixture
from inhand_tracker.methods.fusion.parameters import FusionParameters
from inhand_tracker.sight.refinement import PosePrior
from inhand_tracker.sight.sight import Sight
from inhand_tracker.sight.view import SightView


@dataclass(frozen=True)
class ImagePosterior:
    """One object's poses, judged by a view of an image and by a belief.

    The image counts by its ``sharpness``, from 0 to 1.
    """

    sight: Sight
    sphere: BoundingSphere
    view: SightView
    belief: PoseMixture
    sharpness: float
    parameters: FusionParameters

    def scores(self, centres: Array, orientations: Array) -> tuple[Array, Array]:
        """Return the log-posterior (P,) of poses (P, 3) and (P, 4), up to a constant, and the
        image's log-likelihood in it, untempered, (P,)."""
        origins = self.sphere.origins(centres, orientations)
        seen = self.sight.log_likelihood(origins, orientations, self.view)
        expected = np.logaddexp.reduce(self.belief.log_densities(centres, orientations), axis=0)
        return self.parameters.image_temper * self.sharpness * seen + expected, seen

    def weigh(self, modes: list[PoseGaussian]) -> tuple[PoseMixture, Array]:
        """Weigh modes by their probability (Laplace's approximation); also the image's
        log-likelihood (K,) of each."""
        scores, seen = self.scores(
            np.array([mode.centre for mode in modes]), np.array([mode.rotation for mode in modes])
        )
        volumes = np.array([0.5 * np.linalg.slogdet(mode.covariance)[1] for mode in modes])
        return mixture(modes, scores + volumes), seen

    def modes(self, centres: Array, orientations: Array) -> list[PoseGaussian]:
        """Find where image and belief agree best near each start (S, 3), (S, 4), each once."""
        nearest = np.argmax(self.belief.log_densities(centres, orientations), axis=0)
        modes: list[PoseGaussian] = []
        for index, part in enumerate(self.belief.parts):
            chosen = nearest == index
            if not chosen.any():
                continue
            starts = centres[chosen], orientations[chosen]
            if not self.parameters.refines:
                poses = zip(*starts, strict=True)
                modes += [PoseGaussian(*pose, part.covariance) for pose in poses]
                continue
            for mode in self._refined(*starts, part):
                if not any(self._same(mode, other) for other in modes):
                    modes.append(mode)
        return modes

    def _refined(
        self, centres: Array, orientations: Array, part: PoseGaussian
    ) -> list[PoseGaussian]:
        """Move poses to where the image and one part of the belief agree."""
        information = np.asarray(np.linalg.inv(part.covariance), np.float64)
        arm = self.sphere.arm(part.rotation)
        forth = lever(arm)
        refined = self.sight.refine(
            self.sphere.origins(centres, orientations),
            orientations,
            self.view,
            PosePrior(part.centre - arm, part.rotation, forth.T @ information @ forth),
            self.parameters.refinement_temper * self.sharpness,
        )
        modes = []
        for origin, rotation, seen in zip(
            refined.translations, refined.rotations, refined.information, strict=True
        ):
            arm = self.sphere.arm(rotation)
            back = lever(-arm)
            covariance = np.linalg.inv(information + back.T @ seen @ back)
            modes.append(PoseGaussian(origin + arm, rotation, covariance))
        return modes

    def _same(self, one: PoseGaussian, other: PoseGaussian) -> bool:
        apart = one.deviations(other.centre[None], other.rotation[None])[0]
        return bool(
            np.linalg.norm(apart[:3]) < self.parameters.same_mode_m
            and np.linalg.norm(apart[3:]) < self.parameters.same_mode_rad
        )
