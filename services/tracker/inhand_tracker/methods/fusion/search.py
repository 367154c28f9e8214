"""Looking for an object in an image: hypotheses from what is believed, weighed by what is seen.

The image weighs hypotheses (``posterior``), and the likeliest of them are refined, beside what was
believed.
"""

from dataclasses import dataclass, replace

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.bounding_sphere import BoundingSphere
from inhand_tracker.geometry.camera import NEAREST_M, Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.geometry.pose_gaussian import PoseGaussian, PoseMixture, means_of
from inhand_tracker.methods.fusion.narrowing import Hypotheses, narrow
from inhand_tracker.methods.fusion.parameters import FusionParameters
from inhand_tracker.methods.fusion.posterior import ImagePosterior
from inhand_tracker.sight.colours import Colours
from inhand_tracker.sight.frame import Region, SightFrame, prepare
from inhand_tracker.sight.kernels.spheres_region import spheres_region
from inhand_tracker.sight.sight import Sight
from inhand_tracker.sight.support import Support
from inhand_tracker.sight.view import SightView


class ImageSearch:
    """Looks for one object in one image after the other, and learns its colours on the way."""

    def __init__(
        self, sight: Sight, sphere: BoundingSphere, parameters: FusionParameters, seed: int
    ) -> None:
        self._sight = sight
        self._sphere = sphere
        self._parameters = parameters
        self._random = np.random.default_rng(seed)
        self._colours = sight.start()
        self._light = sight.watch_light()
        self._looks = 0
        self._found: _Found | None = None
        self._support: Support | None = None
        self.convinces = False
        """Whether the last image supports the pose that was found."""
        self.tried: Hypotheses | None = None
        """The last look's hypotheses; None where the object was out of the image."""

    def look(
        self,
        belief: PoseMixture,
        image: Image,
        joints: Array,
        sharpness: float,
        effort: float = 1.0,
        *,
        thoroughly: bool = False,
    ) -> PoseGaussian | None:
        """Return what is believed after a look at the image; None where the object is out of it.

        ``joints`` (20, 3) in the camera frame; an image counts by ``sharpness``, from 0 to 1; fewer
        hypotheses are tried with less ``effort`` than 1. ``thoroughly`` where bodies say little of
        the object: hypotheses are narrowed down then, as they are where a sharp image supports none
        of the poses that were found.
        """
        self._support = None
        parameters = self._parameters.with_effort(effort)
        hypotheses = belief.sample(parameters.hypotheses, self._random)
        region = self._region(self._sphere.middles(*hypotheses), image.camera)
        if region is None:
            self._found = self.tried = None
            self.convinces = False
            return None
        view = self._open(belief.parts[0], image, region, joints)
        posterior = ImagePosterior(self._sight, self._sphere, view, belief, sharpness, parameters)
        posterior, scores = self._compare_unseen(posterior, *hypotheses)
        self.tried = Hypotheses(*hypotheses, scores)
        found = None if thoroughly else self._modes(posterior, self.tried)
        if found is None or _unconvincing(found[1], posterior):
            self.tried = narrow(posterior, self.tried, self._random)
            posterior = replace(posterior, thorough=True)
            found = self._modes(posterior, self.tried)
        modes, seen = found
        weighed = posterior.weigh(modes, seen)
        if self._looks % parameters.looks_to_learn == 0:
            best = int(np.argmax(weighed.weights))
            shown = seen[best] > parameters.learning_log_likelihood
            rate = parameters.learning_rate if shown else 0.0
            self._learn_colours(modes[best], view.frame, of_object=rate)
        self._looks += 1
        self._found = _Found(modes, posterior.view, self._colours, joints)
        best = seen[int(np.argmax(weighed.weights))]
        self.convinces = best >= parameters.unconvincing_log_likelihood
        return weighed.moments()

    @property
    def support(self) -> Support | None:
        """The last image's support for the object; None where it shows nothing of it.

        It is found when it is first asked for: only recognition does.
        """
        if self._support is None and self._found is not None:
            self._support = self._supported(self._found)
        return self._support

    def _region(self, centres: Array, camera: Intrinsics) -> Region | None:
        """The part of the image that hypotheses (P, 3) lie in; None where they are out of it."""
        reach = self._parameters.region_margin * self._sphere.radius
        left, top, right, bottom = spheres_region(centres, reach, camera.lens)
        # Compared so that nothing is there where no centre is before the camera.
        if not (right > 0.0 and bottom > 0.0 and left < camera.width and top < camera.height):
            return None
        return left, top, right, bottom

    def _own_pixels(self, guess: PoseGaussian, camera: Intrinsics) -> float:
        """Number of pixels that would be prepared if the pose were known."""
        reach = self._parameters.region_margin * self._sphere.radius
        across = 2.0 * reach * camera.fx / max(float(guess.centre[2]), NEAREST_M)
        return across * across

    def _open(self, guess: PoseGaussian, image: Image, region: Region, joints: Array) -> SightView:
        """Prepare a region of the image, in the light of training; in the first one the
        surroundings' colours are learned."""
        own_pixels = self._own_pixels(guess, image.camera)
        most_pixels = max(self._parameters.most_pixels, 2.0 * own_pixels)
        if self._looks % self._parameters.looks_to_learn == 0:
            self._light.watch(image, joints)
        frame = prepare(image, region, self._parameters.sight, most_pixels, self._light.gains)
        if self._found is None:
            self._learn_colours(guess, frame, of_object=0.0)
        return self._sight.view(frame, self._colours, joints)

    def _compare_unseen(
        self, posterior: ImagePosterior, centres: Array, orientations: Array
    ) -> tuple[ImagePosterior, Array]:
        """The posterior in which not to be seen is as likely as to be, by poses (P, 3), (P, 4) of
        what is believed, and their log-posterior (P,)."""
        origins = self._sphere.origins(centres, orientations)
        weighed = self._sight.weigh(origins, orientations, posterior.view, quickly=True)
        parameters = posterior.parameters
        trust = parameters.image_temper * max(posterior.sharpness, parameters.least_sharpness)
        view = self._sight.compare_unseen(weighed, posterior.view, trust)
        posterior = replace(posterior, view=view)
        return posterior, posterior.scores_by(weighed, centres, orientations)[0]

    def _modes(
        self, posterior: ImagePosterior, tried: Hypotheses
    ) -> tuple[list[PoseGaussian], Array]:
        """The ``modes`` near the means of parts that are believed, and near the likeliest of the
        hypotheses that were ``tried``."""
        means, turns = posterior.belief.means
        parameters = posterior.parameters
        believed = posterior.belief.weights >= parameters.least_refined_weight
        likeliest = tried.best(
            parameters.narrowed_refined if posterior.thorough else parameters.refined_hypotheses
        )
        return posterior.modes(
            np.concatenate((means[believed], likeliest.centres)),
            np.concatenate((turns[believed], likeliest.orientations)),
        )

    def _learn_colours(self, pose: PoseGaussian, frame: SightFrame, *, of_object: float) -> None:
        """Learn the surroundings' colours at a pose; a share ``of_object`` of the object's, too."""
        self._colours = self._sight.learn(
            self._colours,
            frame,
            pose.centre - self._sphere.arm(pose.rotation),
            pose.rotation,
            of_object=of_object,
            around=self._parameters.around_rate,
        )

    def _supported(self, found: "_Found") -> Support:
        """The image's support by the colours of training: what was learned since may be another
        thing's."""
        trained = replace(found.colours, of_object=self._sight.start().of_object, mixed=None)
        trained_view = self._sight.view(found.view.frame, trained, found.joints)
        centres, orientations = means_of(found.modes)
        origins = self._sphere.origins(centres, orientations)
        terms = self._sight.log_likelihoods_by_term(origins, orientations, trained_view)
        best = int(np.argmax(sum(terms.values())))
        by_training = {term: float(values[best]) for term, values in terms.items()}
        if trained.of_object is None:
            return Support(**by_training)
        pose = origins[best : best + 1], orientations[best : best + 1]
        by_learning = self._sight.log_likelihoods_by_term(*pose, found.view)
        recoloured = float(by_learning["interior"][0]) - by_training["interior"]
        return Support(**by_training, recoloured=recoloured)


def _unconvincing(seen: Array, posterior: ImagePosterior) -> bool:
    """Whether a sharp image supports none of the poses that were found, by its log-likelihoods."""
    parameters = posterior.parameters
    return bool(
        posterior.sharpness >= parameters.least_narrowed_sharpness
        and seen.max() < parameters.unconvincing_log_likelihood
    )


@dataclass(frozen=True)
class _Found:
    """What a look found: the modes in a view, the colours after it, and the person's joints
    (20, 3)."""

    modes: list[PoseGaussian]
    view: SightView
    colours: Colours
    joints: Array
