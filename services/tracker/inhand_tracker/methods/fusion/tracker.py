"""The tracker that users get: a prior from the body's motion, what it carries over, and the image.

What is believed before an image is seen is ``belief``'s, the search in it ``search``'s.
"""

from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from inhand_tracker.body.reader import Body, BodyReader
from inhand_tracker.body.skeleton import mirror_joints
from inhand_tracker.body.window import BodyWindow, continues
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Singles
from inhand_tracker.geometry.bounding_sphere import BoundingSphere
from inhand_tracker.geometry.considered import Considered
from inhand_tracker.geometry.estimate import AGREEMENT_M, AGREEMENT_RAD, Estimate
from inhand_tracker.geometry.image import Image, OtherView
from inhand_tracker.geometry.kernels.pose_normals import share_near
from inhand_tracker.geometry.motion import Motion
from inhand_tracker.geometry.placement import HERE, Placement
from inhand_tracker.geometry.pose_gaussian import PoseGaussian, PoseMixture, moved_covariance
from inhand_tracker.geometry.weights import normalised_weights
from inhand_tracker.methods.follower import Follower, FollowingTracker
from inhand_tracker.methods.fusion.belief import (
    Belief,
    BodyExpectation,
    Expected,
    carry_on,
    carry_over,
    expect_afresh,
    farthest_way,
    steady_before,
)
from inhand_tracker.methods.fusion.parameters import DEFAULT_FUSION, FusionParameters
from inhand_tracker.methods.fusion.search import ImageSearch, SideLook
from inhand_tracker.model.model import Model, ModelError
from inhand_tracker.sight.sight import SIGHT_TERMS, Sight, SightTerm, blank_image
from inhand_tracker.sight.support import Support

USUAL_HEIGHT_M = 1.7
_FRAME_NS = 33_333_333
"""Time between the frames by which a tracker compiles."""
_NOBODY = np.full((20, 3), np.nan)
"""The joints of a body that is not seen."""


class FusionTracker(FollowingTracker):
    """Follows one object of one person through the frames of one camera, or of several cameras
    whose images are beside that one's.

    What a first frame of ``several_cameras`` would wait for is compiled with the rest. Raises
    ModelError for a model of a release that learned no prior.
    """

    def __init__(
        self,
        model: Model,
        *,
        left_handed: bool = False,
        terms: Collection[SightTerm] = SIGHT_TERMS,
        parameters: FusionParameters = DEFAULT_FUSION,
        seed: int = 0,
        several_cameras: bool = False,
    ) -> None:
        if model.prior is None:
            raise ModelError(
                f"the model of {model.shape.name} is of an older release and holds no prior: "
                "train it again, or choose another method"
            )
        super().__init__(model, left_handed=left_handed)
        expectation = BodyExpectation(
            model.prior, model.shape.mirror_normal, left_handed, parameters.prior
        )
        radius = np.linalg.norm(model.shape.vertices - model.prior.centre, axis=1).max()
        sphere = BoundingSphere(expectation.centre, float(radius), expectation.pivot)
        self._object = _FusedObject(expectation, sphere, parameters)
        self._sight: Sight | None = None
        if terms:
            self._sight = Sight(
                model.shape, model.viewpoints, model.appearance, terms, parameters=parameters.sight
            )
            self._sight.compile()
        self._seed = seed
        self._compile(several_cameras=several_cameras)
        self.restart()

    def _compile(self, *, several_cameras: bool) -> None:
        """Compile what frames would wait for, by two of somebody usual 2 m ahead: the second one
        takes over what the first one gave."""
        pose = self._mapping.body_poses.mean(axis=0).reshape(20, 3)
        joints = USUAL_HEIGHT_M * pose + np.array([0.0, 0.0, 2.0])
        image = blank_image()
        if several_cameras:
            image = replace(image, others=(OtherView(replace(image, source="other"), HERE),))
        self.restart()
        for time_ns in (0, _FRAME_NS):
            estimate = self.step(joints, time_ns, None if self._sight is None else image)
        self.outline(estimate, image.camera)

    def _start(self, *, alone: bool) -> Follower:
        search = None
        if self._sight is not None:
            sphere, parameters = self._object.sphere, self._object.parameters
            search = ImageSearch(self._sight, sphere, parameters, self._seed)
        return FusionFollower(self._object, search, self.new_reader())


@dataclass(frozen=True)
class _FusedObject:
    """What all followers of a tracker share."""

    expectation: BodyExpectation
    sphere: BoundingSphere
    parameters: FusionParameters


class FusionFollower(Follower):
    """Follows one object of one person, from when they came into view; by the body alone, where
    there is no ``search``."""

    def __init__(
        self, tracked: _FusedObject, search: ImageSearch | None, reader: BodyReader
    ) -> None:
        super().__init__(reader)
        self._expectation = tracked.expectation
        self._sphere = tracked.sphere
        self._parameters = tracked.parameters
        self._search = search
        self._window = BodyWindow()
        self._before: Belief | None = None
        self._body: tuple[Body, list[Singles]] | None = None

    def remember(self, body: Body, time_ns: int) -> None:
        self._window.add(body.joints, time_ns, body.height)

    def estimate(self, body: Body, time_ns: int, image: Image | None) -> Estimate:
        descriptions = self._window.add(body.joints, time_ns, body.height)
        self._body = body, descriptions
        looks = self._search is not None and image is not None
        expected = self._expectation.expect(body, descriptions, apart=looks)
        belief = self._carry_over(expected, time_ns)
        seen = self._look(belief, expected, body, time_ns, image)
        believed = belief.parts[0] if seen is None else seen
        self._before = self._after(expected, believed, time_ns)
        return self._state(believed, seen=seen is not None)

    def watch(self, time_ns: int, image: Image | None) -> Estimate | None:
        """A body may be lost while an object that was followed is plainly seen: it stays where it
        was, or goes on as it went, as far as the image supports it."""
        before = self._before
        if before is None or self._search is None or image is None:
            return None
        if not continues(before.time_ns, time_ns):
            return None
        belief = carry_on(before, time_ns, self._parameters)
        sharpness = self._sharpness(Expected(belief.parts[-1]), image)
        others = self._others(belief, Expected(belief.parts[-1]), image, time_ns)
        seen = self._search.look(belief, image, _NOBODY, sharpness, self.effort, others)
        if seen is None or not self._search.convinces:
            return None
        self._before = self._after(Expected(seen), seen, time_ns)
        return self._state(seen, seen=True)

    def considered(self) -> Considered | None:
        if self._body is None:
            return None
        predictions = {
            name: (self._sphere.origins(pose.centre, pose.rotation), pose.rotation)
            for name, pose in self._expectation.expect_apart(*self._body).items()
        }
        if self._search is None or not self._looked or (tried := self._search.tried) is None:
            return Considered(np.zeros((0, 3)), np.zeros((0, 4)), np.zeros(0), predictions)
        origins = self._sphere.origins(tried.centres, tried.orientations)
        weights = normalised_weights(tried.scores)
        return Considered(origins, tried.orientations, weights, predictions)

    @property
    def support(self) -> Support | None:
        return self._search.support if self._search is not None and self._looked else None

    def _after(self, expected: Expected, believed: PoseGaussian, time_ns: int) -> Belief:
        """The belief at the end of a frame, with the frame before it where that is not long ago."""
        before = self._before
        if before is None or not continues(before.time_ns, time_ns):
            return Belief(expected, believed, time_ns)
        steady = steady_before(before, expected, time_ns, self._parameters)
        if steady is not None:
            steady = replace(steady, earlier=None)
        earlier = replace(before, earlier=None, steady=None)
        return Belief(expected, believed, time_ns, earlier, steady)

    def _carry_over(self, expected: Expected, time_ns: int) -> PoseMixture:
        """What is believed before the image is seen; after a gap, what the body says alone."""
        before, alone = self._before, expect_afresh(expected)
        if before is None or not self._parameters.carries:
            return alone
        if not continues(before.time_ns, time_ns):
            return alone
        persistence_s = self._expectation.prior.persistence_s
        return carry_over(before, expected, time_ns, persistence_s, self._parameters)

    def _look(
        self,
        belief: PoseMixture,
        expected: Expected,
        body: Body,
        time_ns: int,
        image: Image | None,
    ) -> PoseGaussian | None:
        """What is believed after a look at the image; None where it shows nothing of the object."""
        if self._search is None or image is None:
            return None
        joints = mirror_joints(body.joints) if self._expectation.left_handed else body.joints
        sharpness = self._sharpness(expected, image)
        others = self._others(belief, expected, image, time_ns)
        seen = self._search.look(
            belief, image, joints, sharpness, self.effort, others, thoroughly=expected.strange
        )
        self._looked = True
        return seen

    def _others(
        self, belief: PoseMixture, expected: Expected, image: Image, time_ns: int
    ) -> list[SideLook]:
        """The images of other cameras, as if they had been captured when this one was: what moves
        the object on its way to where it is believed to be goes on for as long as they are later.

        The longer that is, and the farther the object goes meanwhile, the less they count.
        """
        if not image.others:
            return []
        motion = self._motion(belief, time_ns)
        return [self._other(one, motion, expected) for one in image.others]

    def _other(self, one: OtherView, motion: Motion, expected: Expected) -> SideLook:
        place = one.view_from_reference @ motion.placement(one.later_s)
        sharpness = self._sharpness(expected, one.image, one.view_from_reference)
        early = one.view_from_reference.points(motion.start)
        late = place.points(motion.start)
        camera = one.image.camera
        off = np.nan_to_num(camera.project(late) - camera.project(early))
        doubt = self._parameters.late_doubt * float(np.linalg.norm(off))
        sharpness /= 1.0 + (doubt / self._parameters.late_pixels) ** 2
        covariance = _place_covariance(one, motion.start)
        share = 1.0 if covariance is None else self._place_share(one, motion.start, covariance)
        return SideLook(one.image, place, sharpness, share, covariance)

    def _place_share(self, one: OtherView, centre: Array, covariance: Array) -> float:
        """How much an image counts of an object that may be off by a covariance, as it is not sure
        where its camera is."""
        away = float(np.linalg.norm(one.view_from_reference.points(centre)))
        off_m = float(np.sqrt(np.trace(covariance[:3, :3])))
        off_pixels = one.image.camera.fx * off_m / away
        return 1.0 / (1.0 + (off_pixels / self._parameters.place_pixels) ** 2)

    def _motion(self, belief: PoseMixture, time_ns: int) -> Motion:
        """How the object moves on its way from where it was believed to be: as the likeliest of the
        parts that go on from there has it, but for those that would go as fast as no object does.
        Where a body alone has it elsewhere, that is no way that it goes."""
        before = self._before
        if before is None or not continues(before.time_ns, time_ns):
            return Motion(belief.parts[0].centre, np.zeros(3), np.zeros(3))
        elapsed_s = (time_ns - before.time_ns) / 1e9
        was = before.believed
        farthest = farthest_way(before, elapsed_s, self._parameters)
        ways = np.linalg.norm(belief.means[0] - was.centre, axis=1)
        possible = [one for one in belief.carried if ways[one] <= farthest]
        if not possible:
            return Motion(was.centre, np.zeros(3), np.zeros(3))
        believed = belief.parts[max(possible, key=lambda one: belief.weights[one])]
        turned = rotations.to_vector(
            rotations.multiply(believed.rotation, rotations.conjugate(was.rotation))
        )
        went = believed.centre - was.centre
        return Motion(believed.centre, went / elapsed_s, turned / elapsed_s)

    def _sharpness(
        self, expected: Expected, image: Image, view_from_reference: Placement | None = None
    ) -> float:
        """Sharpness, from 0 to 1, of an object that moved to where it is expected, as far as it was
        moving already: a body's glitch blurs nothing. It is whole where the posture is strange, as
        even a smear says more than the body does."""
        before = self._before
        if before is None or expected.strange:
            return 1.0
        lens, place = image.camera, view_from_reference
        way = self._sphere.way(before.expected.whole, expected.whole, lens, place)
        if before.earlier is not None:
            went = self._sphere.way(before.earlier.believed, before.believed, lens, place)
            way = min(way, self._parameters.quickening * went)
        return 1.0 / (1.0 + (way / self._parameters.blurred_pixels) ** 2)

    def _state(self, believed: PoseGaussian, *, seen: bool) -> Estimate:
        """The estimate of the object's origin, with its covariance and confidence."""
        scale = self._parameters.seen_covariance_scale if seen else 1.0
        stated = replace(believed, covariance=scale * believed.covariance)
        arm = self._sphere.arm(stated.rotation)
        middle = self._sphere.middles(stated.centre, stated.rotation)
        of_middle = moved_covariance(stated.covariance, middle - stated.centre)
        return Estimate(
            "tracked",
            confidence_of(
                PoseGaussian(middle, stated.rotation, of_middle),
                self._parameters.confidence_samples,
            ),
            stated.centre - arm,
            stated.rotation,
            moved_covariance(stated.covariance, -arm),
        )


def _place_covariance(one: OtherView, centre: Array) -> Array | None:
    """By how much an object at a point (3,) may be off in a camera's image, as it is not sure where
    the camera is: a covariance (6, 6) in the frame of reference."""
    if one.place_covariance is None:
        return None
    arm = centre - one.view_from_reference.inverse().translation
    return moved_covariance(one.place_covariance, arm)


def confidence_of(pose: PoseGaussian, samples: int) -> float:
    """Probability that the true pose is within 10 cm and 30° of the mean."""
    near = AGREEMENT_M, AGREEMENT_RAD
    return float(share_near(_standard_normal(samples), pose.root, *near))


@cache
def _standard_normal(samples: int) -> Array:
    """The same draws (S, 6) for every confidence, so that it depends on the estimate alone."""
    return np.random.default_rng(0).normal(size=(samples, 6))
