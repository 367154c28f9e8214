"""Looking for an object in images: hypotheses from what is believed, weighed by what is seen.

The image of one camera, or those of several of the same moment, weigh hypotheses (``posterior``),
and the likeliest of them are refined, beside what was believed.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.bounding_sphere import BoundingSphere
from inhand_tracker.geometry.camera import NEAREST_M, Intrinsics
from inhand_tracker.geometry.image import Image, ViewPull
from inhand_tracker.geometry.placement import Placement
from inhand_tracker.geometry.pose_gaussian import PoseGaussian, PoseMixture, means_of
from inhand_tracker.methods.fusion.narrowing import Hypotheses, narrow
from inhand_tracker.methods.fusion.parameters import FusionParameters
from inhand_tracker.methods.fusion.posterior import ImagePosterior
from inhand_tracker.methods.fusion.pulls import pulls_of
from inhand_tracker.sight.colours import Colours
from inhand_tracker.sight.frame import Region, SightFrame, prepare
from inhand_tracker.sight.kernels.spheres_region import spheres_region
from inhand_tracker.sight.kernels.weigh import VISIBLE
from inhand_tracker.sight.light import LightWatch
from inhand_tracker.sight.sight import Sight
from inhand_tracker.sight.support import Support
from inhand_tracker.sight.view import PlacedView, SightView


@dataclass(frozen=True)
class SideLook:
    """An image of another camera, which stands at ``view_from_reference`` from the frame of
    reference that poses are in at the moment that is looked at; it counts by ``sharpness``, from 0
    to 1, and beside others by ``share``, as far as it is sure where the camera is; by that,
    objects near the one that is looked for may be off by ``place_covariance`` (6, 6)."""

    image: Image
    view_from_reference: Placement
    sharpness: float
    share: float = 1.0
    place_covariance: Array | None = None


class ImageSearch:
    """Looks for one object in one moment's images after the other, and learns its colours on the
    way: each camera sees colours, and light, of its own."""

    def __init__(
        self, sight: Sight, sphere: BoundingSphere, parameters: FusionParameters, seed: int
    ) -> None:
        self._sight = sight
        self._sphere = sphere
        self._parameters = parameters
        self._random = np.random.default_rng(seed)
        self._eyes: dict[str, _Eye] = {}
        self._looks = 0
        self._found: _Found | None = None
        self._support: Support | None = None
        self.convinces = False
        """Whether the last images support the pose that was found."""
        self.tried: Hypotheses | None = None
        """The last look's hypotheses; None where the object was out of the images."""

    def look(
        self,
        belief: PoseMixture,
        image: Image,
        joints: Array,
        sharpness: float,
        effort: float = 1.0,
        others: Sequence[SideLook] = (),
        *,
        thoroughly: bool = False,
    ) -> PoseGaussian | None:
        """Return what is believed after a look at an image, and those of ``others``; None where the
        object is out of them.

        ``joints`` (20, 3) in the camera frame; an image counts by ``sharpness``, from 0 to 1; fewer
        hypotheses are tried with less ``effort`` than 1. ``thoroughly`` where bodies say little of
        the object: hypotheses are narrowed down then, as they are where sharp images support none
        of the poses that were found.
        """
        self._support = None
        parameters = self._parameters.with_effort(effort)
        glances = [_Glance(image, None, sharpness)] if image.has_pixels or not others else []
        glances += [
            _Glance(
                one.image, one.view_from_reference, one.sharpness, one.share, one.place_covariance
            )
            for one in others
        ]
        doubted = _doubted(belief, len(glances), parameters)
        tried = belief
        if len(glances) > 1:
            tried = belief.with_carried(parameters.carried_tried_share)
            belief = belief.with_carried(parameters.wrong_body_share)
        hypotheses = tried.sample(parameters.hypotheses, self._random)
        at = self._sphere.middles(*(mean[doubted] for mean in belief.means))
        middles = np.concatenate((self._sphere.middles(*hypotheses), at))
        opened = self._open_all(glances, belief.parts[0], middles, joints)
        if not opened:
            self._found = self.tried = None
            self.convinces = False
            return None
        sharpest = max(glance.sharpness for glance, _ in opened)
        surest = max(glance.share for glance, _ in opened)
        views = tuple(glance.placed(view, sharpest, surest) for glance, view in opened)
        posterior = ImagePosterior(self._sight, self._sphere, views, belief, sharpest, parameters)
        posterior, scores = self._compare_unseen(posterior, *hypotheses)
        self.tried = Hypotheses(*hypotheses, scores)
        found = None if thoroughly else self._modes(posterior, self.tried, doubted)
        if found is None or _unconvincing(found[1], posterior):
            self.tried = narrow(posterior, self.tried, self._random)
            posterior = replace(posterior, thorough=True)
            found = self._modes(posterior, self.tried, doubted)
        modes, seen = found
        weighed = posterior.weigh(modes, seen)
        best = int(np.argmax(weighed.weights))
        names = [glance.image.source for glance, _ in opened]
        self._learn(names, posterior, modes[best], float(seen[best]))
        self._looks += 1
        if image.on_pulls is not None:
            self._tell(image.on_pulls, opened, posterior, modes[best])
        colours = [self._eyes[name].colours for name in names]
        self._found = _Found(modes, posterior.views, colours, joints)
        self.convinces = seen[best] >= posterior.unconvincing
        return weighed.moments()

    @property
    def support(self) -> Support | None:
        """The last images' support for the object; None where they show nothing of it.

        It is found when it is first asked for: only recognition does.
        """
        if self._support is None and self._found is not None:
            self._support = self._supported(self._found)
        return self._support

    def _open_all(
        self,
        glances: Sequence["_Glance"],
        guess: PoseGaussian,
        middles: Array,
        joints: Array,
    ) -> list[tuple["_Glance", SightView]]:
        """Prepare the images that an object at one of the ``middles`` (P, 3) lies in."""
        opened = []
        for glance in glances:
            region = self._region(glance.points(middles), glance.image.camera)
            eye = self._eye(glance.image.source)
            if region is None:
                eye.opened = False
                continue
            placed = _placed(guess, glance.view_from_reference)
            view = self._open(eye, placed, glance.image, region, glance.points(joints))
            opened.append((glance, view))
        return opened

    def _eye(self, source: str) -> "_Eye":
        """What is known of a camera's images."""
        if source not in self._eyes:
            number = len(self._eyes)
            self._eyes[source] = _Eye(number, self._sight.start(), self._sight.watch_light())
        return self._eyes[source]

    def _teaches(self, eye: "_Eye") -> bool:
        """Whether a camera's image is one that teaches; those of several take turns."""
        return (self._looks + eye.number) % self._parameters.looks_to_learn == 0

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

    def _open(
        self, eye: "_Eye", guess: PoseGaussian, image: Image, region: Region, joints: Array
    ) -> SightView:
        """Prepare a region of an image, in the light of training; in a camera's first one the
        surroundings' colours are learned. Guess and joints are in that camera's frame."""
        own_pixels = self._own_pixels(guess, image.camera)
        most_pixels = max(self._parameters.most_pixels, 2.0 * own_pixels)
        if self._teaches(eye):
            eye.light.watch(image, joints)
        frame = prepare(image, region, self._parameters.sight, most_pixels, eye.light.gains)
        if not eye.opened:
            self._learn_colours(eye, guess, frame, of_object=0.0)
        eye.opened = True
        return self._sight.view(frame, eye.colours, joints)

    def _compare_unseen(
        self, posterior: ImagePosterior, centres: Array, orientations: Array
    ) -> tuple[ImagePosterior, Array]:
        """The posterior in which not to be seen is as likely as to be, by poses (P, 3), (P, 4) of
        what is believed, and their log-posterior (P,)."""
        weighed = posterior.weighed(centres, orientations, quickly=True)
        parameters = posterior.parameters
        views = []
        for one, scores in zip(posterior.views, weighed, strict=True):
            sharpness = max(posterior.sharpness * one.sharpness, parameters.least_sharpness)
            trust = parameters.image_temper * sharpness
            views.append(replace(one, view=self._sight.compare_unseen(scores, one.view, trust)))
        posterior = replace(posterior, views=tuple(views))
        scores = posterior.scores_by(weighed, centres, orientations)[0]
        return replace(posterior, shown=_shown(posterior, weighed, scores)), scores

    def _modes(
        self, posterior: ImagePosterior, tried: Hypotheses, doubted: list[int]
    ) -> tuple[list[PoseGaussian], Array]:
        """The ``modes`` near the means of parts that are believed, or ``doubted``, and near the
        likeliest of the hypotheses that were ``tried``."""
        means, turns = posterior.belief.means
        parameters = posterior.parameters
        believed = posterior.belief.weights >= parameters.least_refined_weight
        believed[doubted] = True
        likeliest = tried.best(
            parameters.narrowed_refined if posterior.thorough else parameters.refined_hypotheses
        )
        return posterior.modes(
            np.concatenate((means[believed], likeliest.centres)),
            np.concatenate((turns[believed], likeliest.orientations)),
        )

    def _learn(
        self, names: Sequence[str], posterior: ImagePosterior, pose: PoseGaussian, seen: float
    ) -> None:
        """Learn colours from the images whose turn it is, at the likeliest pose, of which all
        images together have a log-likelihood of ``seen``."""
        parameters = posterior.parameters
        for name, one in zip(names, posterior.views, strict=True):
            eye = self._eyes[name]
            if not self._teaches(eye):
                continue
            own = seen if len(names) == 1 else self._seen_in(one, pose)
            rate = parameters.learning_rate if own > parameters.learning_log_likelihood else 0.0
            placed = _placed(pose, one.view_from_reference)
            self._learn_colours(eye, placed, one.view.frame, of_object=rate)

    def _tell(
        self,
        on_pulls: Callable[[Sequence[ViewPull]], None],
        opened: Sequence[tuple["_Glance", SightView]],
        posterior: ImagePosterior,
        pose: PoseGaussian,
    ) -> None:
        """Tell, now and then, what each sharp image alone says of a pose that was found."""
        parameters = posterior.parameters
        if len(opened) < 2 or self._looks % parameters.looks_to_place:
            return
        views = [
            (glance.image.source, replace(one, sharpness=glance.sharpness), glance.place_covariance)
            for (glance, _), one in zip(opened, posterior.views, strict=True)
            if glance.sharpness >= parameters.least_narrowed_sharpness
        ]
        origin = pose.centre - self._sphere.arm(pose.rotation)
        on_pulls(pulls_of(self._sight, views, (origin, pose.rotation), parameters))

    def _seen_in(self, one: PlacedView, pose: PoseGaussian) -> float:
        """The log-likelihood of a pose by one view alone."""
        origin = self._sphere.origins(pose.centre[None], pose.rotation[None])
        poses = one.poses(origin, pose.rotation[None])
        return float(self._sight.log_likelihood(*poses, one.view)[0])

    def _learn_colours(
        self, eye: "_Eye", pose: PoseGaussian, frame: SightFrame, *, of_object: float
    ) -> None:
        """Learn the surroundings' colours at a pose in a camera's frame; a share ``of_object`` of
        the object's, too."""
        eye.colours = self._sight.learn(
            eye.colours,
            frame,
            pose.centre - self._sphere.arm(pose.rotation),
            pose.rotation,
            of_object=of_object,
            around=self._parameters.around_rate,
        )

    def _supported(self, found: "_Found") -> Support:
        """The images' mean support by the colours of training: what was learned since may be
        another thing's."""
        centres, orientations = means_of(found.modes)
        origins = self._sphere.origins(centres, orientations)
        of_object = self._sight.start().of_object
        by_training = []
        for one, colours in zip(found.views, found.colours, strict=True):
            trained = replace(colours, of_object=of_object, mixed=None)
            joints = one.points(found.joints)
            view = self._sight.view(one.view.frame, trained, joints)
            poses = one.poses(origins, orientations)
            by_training.append(self._sight.log_likelihoods_by_term(*poses, view))
        terms = _mean_terms(by_training)
        best = int(np.argmax(sum(terms.values())))
        supported = {term: float(values[best]) for term, values in terms.items()}
        if of_object is None:
            return Support(**supported)
        pose = origins[best : best + 1], orientations[best : best + 1]
        by_learning = _mean_terms(
            [
                self._sight.log_likelihoods_by_term(*one.poses(*pose), one.view)
                for one in found.views
            ]
        )
        recoloured = float(by_learning["interior"][0]) - supported["interior"]
        return Support(**supported, recoloured=recoloured)


def _mean_terms(each: Sequence[Mapping[str, Array]]) -> dict[str, Array]:
    """Average the terms (P,) of several views."""
    first, *others = each
    if not others:
        return dict(first)
    return {term: np.mean([one[term] for one in each], axis=0) for term in first}


def _placed(pose: PoseGaussian, place: Placement | None) -> PoseGaussian:
    """Take a distribution's mean to a camera's frame; its covariance stays as it is."""
    if place is None:
        return pose
    centre, rotation = place.poses(pose.centre, pose.rotation)
    return replace(pose, centre=centre, rotation=rotation)


@dataclass(frozen=True)
class _Glance:
    """An image that is looked at; ``view_from_reference`` is None for that of the reference."""

    image: Image
    view_from_reference: Placement | None
    sharpness: float
    share: float = 1.0
    place_covariance: Array | None = None

    def points(self, points: Array) -> Array:
        """Take points (..., 3) to the camera's frame."""
        place = self.view_from_reference
        return points if place is None else place.points(points)

    def placed(self, view: SightView, sharpest: float, surest: float) -> PlacedView:
        """Place the view of this image, which counts as a share of the ``sharpest`` one, and of the
        one whose camera's place is ``surest``."""
        share = 1.0 if self.sharpness == sharpest else self.sharpness / sharpest
        return PlacedView(view, self.view_from_reference, share * (self.share / surest))


@dataclass
class _Eye:
    """What is known of one camera's images: its ``number`` among those that were looked at, the
    colours as it sees them, and the light; ``opened`` is whether its last image was looked at."""

    number: int
    colours: Colours
    light: LightWatch
    opened: bool = False


def _shown(posterior: ImagePosterior, weighed: Sequence[Array], scores: Array) -> float:
    """Number of whole sharp images that show the object as several cameras do, one at the least,
    by the likeliest of poses that were ``weighed`` in each view, (P, 5)."""
    if len(weighed) == 1:
        return 1.0
    best = int(np.argmax(scores))
    each = zip(posterior.views, weighed, strict=True)
    return max(1.0, float(sum(one.sharpness * seen[best, VISIBLE] for one, seen in each)))


def _doubted(belief: PoseMixture, images: int, parameters: FusionParameters) -> list[int]:
    """The parts that go on from what was believed a moment before, where a body makes all of them
    so unlikely that hardly a hypothesis is near: it may have left the object, as several images
    show plainly. What that is worth with one image was not measured."""
    carried = list(belief.carried)
    if images < 2 or (belief.weights[carried] >= parameters.least_refined_weight).any():
        return []
    return carried


def _unconvincing(seen: Array, posterior: ImagePosterior) -> bool:
    """Whether sharp images support none of the poses that were found, by their log-likelihoods."""
    parameters = posterior.parameters
    return bool(
        posterior.sharpness >= parameters.least_narrowed_sharpness
        and seen.max() < posterior.unconvincing
    )


@dataclass(frozen=True)
class _Found:
    """What a look found: the modes in the views, each view's colours after it, and the person's
    joints (20, 3)."""

    modes: list[PoseGaussian]
    views: tuple[PlacedView, ...]
    colours: list[Colours]
    joints: Array
