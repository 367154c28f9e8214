"""Looking for an object in an image: hypotheses from what is believed, weighed by what is seen.

The image weighs hypotheses (``sight``), more are tried near the likeliest, and the best of all are
refined.
"""

from dataclasses import dataclass, replace

import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.bounding_sphere import BoundingSphere
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.geometry.pose_gaussian import PoseGaussian, PoseMixture, lever, mixture
from inhand_tracker.sight.frame import Region, prepare
from inhand_tracker.sight.refinement import Prior as RefinementPrior
from inhand_tracker.sight.sight import Sight, SightView
from inhand_tracker.sight.support import Support

REFINED = 3
"""So many of the likeliest hypotheses."""
SEEDS, CLOSER = 20, 0.35
"""Around so many of the likeliest hypotheses as many again, so much nearer, are tried."""
TEMPER = 0.4
"""How much of an image's log-likelihood counts: one frame's errors are the next one's too."""
INDEPENDENT = 0.1
"""The same of what it says in refinement."""
LEAST_SHARPNESS = 1e-3
SAME_M, SAME_RAD = 0.01, 0.1
"""Refined poses no farther apart than this are the same one."""
AROUND_RATE = 0.3
LEARNING_RATE = 0.05
LEARNING_LOG_LIKELIHOOD = 3.0
"""An estimate that the image supports so much teaches the object's colours."""


@dataclass(frozen=True)
class Search:
    """How poses are looked for: so many hypotheses in each of the rounds.

    The rest is taken out to see what it is worth (``inhand bench ablation``): what was seen before
    is carried over, an object may have been left somewhere, and the likeliest are refined.
    """

    hypotheses: int = 250
    rounds: int = 2
    carries: bool = True
    leaves: bool = True
    refines: bool = True


DEFAULT_SEARCH = Search()


class ImageSearch:
    """Looks for one object in one image after the other, and learns its colours on the way."""

    def __init__(self, sight: Sight, sphere: BoundingSphere, search: Search, seed: int) -> None:
        self._sight = sight
        self._sphere = sphere
        self._search = search
        self._random = np.random.default_rng(seed)
        self._colours = sight.start()
        self.support: Support | None = None

    def look(
        self, belief: PoseMixture, image: Image, joints: Array, sharpness: float
    ) -> PoseGaussian | None:
        """What is believed after a look at the image; None where the object is out of it.

        ``joints`` (20, 3) in the camera frame; an image counts by ``sharpness``, from 0 to 1.
        """
        self.support = None
        count = self._search.hypotheses
        centres, orientations = belief.sample(count, self._random)
        region = self._region(centres, image.camera)
        if region is None:
            return None
        view = self._open(belief.parts[0], image, region, joints)
        origins = self._sphere.origins(centres, orientations)
        trust = TEMPER * max(sharpness, LEAST_SHARPNESS)
        view = self._sight.compare_unseen(origins, orientations, view, trust)
        look = _Look(self._sight, self._sphere, view, belief, sharpness)
        scores, _ = look.scores(centres, orientations)
        root = np.linalg.cholesky(belief.moments().covariance)
        for round_ in range(1, self._search.rounds):
            best = np.resize(np.argsort(scores)[::-1][:SEEDS], count)
            shifts = CLOSER**round_ * self._random.normal(size=(count, 6)) @ root.T
            nearer = centres[best] + shifts[:, :3]
            turned = rotations.multiply(rotations.from_vector(shifts[:, 3:]), orientations[best])
            centres = np.concatenate((centres, nearer))
            orientations = np.concatenate((orientations, turned))
            scores = np.concatenate((scores, look.scores(nearer, turned)[0]))
        likeliest = np.argsort(scores)[::-1][:REFINED]
        centres = np.concatenate(([part.centre for part in belief.parts], centres[likeliest]))
        orientations = np.concatenate(
            ([part.rotation for part in belief.parts], orientations[likeliest])
        )
        modes = look.modes(centres, orientations, refines=self._search.refines)
        found = self._weigh(modes, look)
        self.support = self._supported(modes, look, joints)
        return found.moments()

    def _supported(self, modes: list[PoseGaussian], look: "_Look", joints: Array) -> Support:
        """By the colours of training: what was learned since may be another thing's."""
        trained = replace(self._colours, of_object=self._sight.start().of_object)
        view = self._sight.view(look.view.frame, trained, joints)
        orientations = np.array([mode.rotation for mode in modes])
        origins = self._sphere.origins(np.array([mode.centre for mode in modes]), orientations)
        terms = self._sight.log_likelihoods_by_term(origins, orientations, view)
        best = int(np.argmax(sum(terms.values())))
        then = {term: float(told[best]) for term, told in terms.items()}
        if trained.of_object is None:
            return Support(**then)
        pose = origins[best : best + 1], orientations[best : best + 1]
        now = self._sight.log_likelihoods_by_term(*pose, look.view)
        return Support(**then, recoloured=float(now["interior"][0]) - then["interior"])

    def _open(self, guess: PoseGaussian, image: Image, region: Region, joints: Array) -> SightView:
        """A region of the image, and its surroundings' colours learned."""
        frame = prepare(image, region)
        origin = guess.centre - self._sphere.arm(guess.rotation)
        self._colours = self._sight.look_around(
            self._colours, frame, origin, guess.rotation, AROUND_RATE
        )
        return self._sight.view(frame, self._colours, joints)

    def _region(self, centres: Array, camera: Intrinsics) -> Region | None:
        """The part of the image that hypotheses (P, 3) lie in; None where they are out of it."""
        pixels = camera.project(centres)
        seen = np.isfinite(pixels).all(axis=1)
        if not seen.any():
            return None
        around = 1.3 * self._sphere.radius * max(camera.fx, camera.fy) / centres[seen, 2]
        left, top = (pixels[seen] - around[:, None]).min(axis=0).tolist()
        right, bottom = (pixels[seen] + around[:, None]).max(axis=0).tolist()
        if right <= 0.0 or bottom <= 0.0 or left >= camera.width or top >= camera.height:
            return None
        return left, top, right, bottom

    def _weigh(self, modes: list[PoseGaussian], look: "_Look") -> PoseMixture:
        """The modes by their probability (Laplace's approximation); the best teaches colours."""
        scores, seen = look.scores(
            np.array([mode.centre for mode in modes]), np.array([mode.rotation for mode in modes])
        )
        room = np.array([0.5 * np.linalg.slogdet(mode.covariance)[1] for mode in modes])
        found = mixture(modes, scores + room)
        best = int(np.argmax(found.weights))
        if seen[best] > LEARNING_LOG_LIKELIHOOD:
            taught = modes[best]
            origin = taught.centre - self._sphere.arm(taught.rotation)
            self._colours = self._sight.learn(
                self._colours, look.view.frame, origin, taught.rotation, LEARNING_RATE
            )
        return found


@dataclass(frozen=True)
class _Look:
    """One image, and what is believed beforehand."""

    sight: Sight
    sphere: BoundingSphere
    view: SightView
    belief: PoseMixture
    sharpness: float

    def scores(self, centres: Array, orientations: Array) -> tuple[Array, Array]:
        """The log-posterior (P,) of poses (P, 3) and (P, 4), up to a constant, and the image's
        part of it as it is, (P,)."""
        origins = self.sphere.origins(centres, orientations)
        seen = self.sight.log_likelihood(origins, orientations, self.view)
        expected = np.logaddexp.reduce(self.belief.log_densities(centres, orientations), axis=0)
        return TEMPER * self.sharpness * seen + expected, seen

    def modes(self, centres: Array, orientations: Array, *, refines: bool) -> list[PoseGaussian]:
        """Where image and belief agree best near each start (S, 3), (S, 4); each place once."""
        nearest = np.argmax(self.belief.log_densities(centres, orientations), axis=0)
        modes: list[PoseGaussian] = []
        for index, part in enumerate(self.belief.parts):
            chosen = nearest == index
            if not chosen.any():
                continue
            starts = centres[chosen], orientations[chosen]
            if not refines:
                poses = zip(*starts, strict=True)
                modes += [PoseGaussian(*pose, part.covariance) for pose in poses]
                continue
            for mode in self._refined(*starts, part):
                if not any(_same(mode, other) for other in modes):
                    modes.append(mode)
        return modes

    def _refined(
        self, centres: Array, orientations: Array, part: PoseGaussian
    ) -> list[PoseGaussian]:
        """Poses moved to where the image and one part of the belief agree."""
        information = np.asarray(np.linalg.inv(part.covariance), np.float64)
        arm = self.sphere.arm(part.rotation)
        forth = lever(arm)
        refined = self.sight.refine(
            self.sphere.origins(centres, orientations),
            orientations,
            self.view,
            RefinementPrior(part.centre - arm, part.rotation, forth.T @ information @ forth),
            INDEPENDENT * self.sharpness,
        )
        modes = []
        for origin, turned, seen in zip(
            refined.translations, refined.rotations, refined.information, strict=True
        ):
            arm = self.sphere.arm(turned)
            back = lever(-arm)
            covariance = np.linalg.inv(information + back.T @ seen @ back)
            modes.append(PoseGaussian(origin + arm, turned, covariance))
        return modes


def _same(one: PoseGaussian, other: PoseGaussian) -> bool:
    apart = one.deviations(other.centre[None], other.rotation[None])[0]
    return bool(np.linalg.norm(apart[:3]) < SAME_M and np.linalg.norm(apart[3:]) < SAME_RAD)
