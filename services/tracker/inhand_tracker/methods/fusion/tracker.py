"""The tracker that users get: a prior from the body's motion, what it carries over, and the image.

What is believed before an image is seen is ``fusion_belief``'s, the search in it
``fusion_search``'s.
"""

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from inhand_tracker.body.reader import Body, BodyReader
from inhand_tracker.body.skeleton import mirror_joints
from inhand_tracker.body.window import GAP_NS, BodyWindow
from inhand_tracker.geometry.ageing import coasted
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.bounding_sphere import BoundingSphere
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.estimate import AGREEMENT_M, AGREEMENT_RAD, LOST, Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.geometry.pose_gaussian import PoseGaussian, PoseMixture, lever
from inhand_tracker.methods.fusion.belief import Belief, BodyExpectation, carry_over
from inhand_tracker.methods.fusion.search import DEFAULT_SEARCH, ImageSearch, Search
from inhand_tracker.model.model import Model, ModelError
from inhand_tracker.shape.viewpoints import VisiblePoints
from inhand_tracker.sight.sight import SIGHT_TERMS, Sight, SightTerm
from inhand_tracker.sight.support import Support

BLURRED_PIXELS = 20.0
"""An object that goes so far from frame to frame is seen half as well: its outline is a smear."""
SEEN_SCALE = 0.7
"""Of the covariance told with an image: Laplace's is too wide, on simulated people of seed 51."""


class FusionTracker:
    """Follows one object of one person through the frames of one camera.

    Raises ModelError for a model of a release that learned no prior.
    """

    def __init__(
        self,
        model: Model,
        *,
        left_handed: bool = False,
        terms: Collection[SightTerm] = SIGHT_TERMS,
        search: Search = DEFAULT_SEARCH,
        seed: int = 0,
    ) -> None:
        if model.prior is None:
            raise ModelError(
                f"the model of {model.shape.name} is of an older release and holds no prior: "
                "train it again, or choose another method"
            )
        self._mapping = model.mapping
        self._expectation = BodyExpectation(model.prior, model.shape.mirror_normal, left_handed)
        self._sphere = BoundingSphere(
            self._expectation.centre,
            float(np.linalg.norm(model.shape.vertices - model.prior.centre, axis=1).max()),
        )
        self._sight: Sight | None = None
        if terms:
            self._sight = Sight(model.shape, model.viewpoints, model.appearance, terms)
            self._sight.compile()
        self._search = search
        self._seed = seed
        self._outline = VisiblePoints(model.viewpoints.directions, model.viewpoints.boundaries)
        self.restart()

    def restart(self) -> None:
        """Forget the person and the object: somebody else comes into view."""
        self._followed = self._afresh()

    def step(self, joints: Array | None, time_ns: int, image: Image | None = None) -> Estimate:
        """One frame: the person's joints (20, 3) in the camera frame, or None, and an image.

        Missing joints are NaN. While the body is not seen the last pose stands for a second, as
        predicted; then the object is lost.
        """
        return self._followed.step(joints, time_ns, image)

    def step_body(self, body: Body | None, time_ns: int, image: Image | None = None) -> Estimate:
        """One frame, as ``step``, of a body that a reader of ``new_reader`` has read."""
        return self._followed.step_body(body, time_ns, image)

    @property
    def support(self) -> Support | None:
        """What the last image says for the object; None where it says nothing."""
        return self._followed.support

    def remember(self, body: Body, time_ns: int) -> None:
        """A frame in which the object is not looked for; what the body did before counts later."""
        self._followed.remember(body, time_ns)

    def estimate_single_frame(self, joints: Array, image: Image | None = None) -> Estimate:
        """The object's pose in a frame by itself; what is tracked is neither used nor changed."""
        return self._afresh().step(joints, 1, image)

    def outline(self, estimate: Estimate, camera: Intrinsics) -> Array | None:
        """Pixels (B, 2) of the boundary of the object at an estimate; None for a lost one."""
        if estimate.translation is None or estimate.rotation is None:
            return None
        points = self._outline.place(estimate.translation[None], estimate.rotation[None])
        return camera.project(points[0])

    def new_reader(self) -> BodyReader:
        """A reader of bodies for trackers of this model and handedness."""
        return BodyReader(self._mapping, left_handed=self._expectation.left_handed)

    def _afresh(self) -> "_Followed":
        looking = None
        if self._sight is not None:
            looking = ImageSearch(self._sight, self._sphere, self._search, self._seed)
        return _Followed(self._expectation, self._sphere, self._search, looking, self.new_reader())


class _Followed:
    """One person and object, from when they came into view."""

    def __init__(
        self,
        expectation: BodyExpectation,
        sphere: BoundingSphere,
        search: Search,
        looking: ImageSearch | None,
        reader: BodyReader,
    ) -> None:
        self._expectation = expectation
        self._sphere = sphere
        self._search = search
        self._looking = looking
        self._reader = reader
        self._window = BodyWindow()
        self._before: Belief | None = None
        self._estimate = LOST
        self._time_ns = 0
        self.support: Support | None = None

    def remember(self, body: Body, time_ns: int) -> None:
        self._window.add(body.joints, time_ns, body.height)

    def step(self, joints: Array | None, time_ns: int, image: Image | None) -> Estimate:
        body = None if joints is None else self._reader.read(joints)
        return self.step_body(body, time_ns, image)

    def step_body(self, body: Body | None, time_ns: int, image: Image | None) -> Estimate:
        self.support = None
        if body is None:
            return self._coast(time_ns)
        expected = self._expectation.expect(body, self._window, time_ns)
        belief = self._carry(expected, time_ns)
        seen = None if image is None else self._look(belief, expected, image, body)
        if image is not None and self._looking is not None:
            self.support = self._looking.support
        believed = belief.parts[0] if seen is None else seen
        self._before, self._time_ns = Belief(expected, believed, time_ns), time_ns
        scale = 1.0 if seen is None else SEEN_SCALE
        self._estimate = self._estimated(replace(believed, covariance=scale * believed.covariance))
        return self._estimate

    def _carry(self, expected: PoseGaussian, time_ns: int) -> PoseMixture:
        before = self._before
        if before is None or not self._search.carries:
            return PoseMixture((expected,), np.ones(1))
        if not 0 < time_ns - before.time_ns <= GAP_NS:
            return PoseMixture((expected,), np.ones(1))
        persistence_s = self._expectation.prior.persistence_s
        return carry_over(before, expected, time_ns, persistence_s, leaves=self._search.leaves)

    def _look(
        self, belief: PoseMixture, expected: PoseGaussian, image: Image, body: Body
    ) -> PoseGaussian | None:
        if self._looking is None:
            return None
        joints = mirror_joints(body.joints) if self._expectation.left_handed else body.joints
        return self._looking.look(belief, image, joints, self._sharpness(expected, image))

    def _sharpness(self, expected: PoseGaussian, image: Image) -> float:
        """How well an object is seen that moved to where it is expected, from 0 to 1."""
        if self._before is None:
            return 1.0
        then, now = (
            image.camera.project(self._sphere.ends(pose))
            for pose in (self._before.expected, expected)
        )
        way = float(np.nan_to_num(np.linalg.norm(now - then, axis=1)).max())
        return 1.0 / (1.0 + (way / BLURRED_PIXELS) ** 2)

    def _estimated(self, believed: PoseGaussian) -> Estimate:
        arm = self._sphere.arm(believed.rotation)
        back = lever(-arm)
        return Estimate(
            "tracked",
            _confidence(believed),
            believed.centre - arm,
            believed.rotation,
            back @ believed.covariance @ back.T,
        )

    def _coast(self, time_ns: int) -> Estimate:
        predicted = coasted(self._estimate, time_ns - self._time_ns)
        if predicted.state == "lost":
            self._estimate = LOST
        return predicted


_STANDARD = np.random.default_rng(0).normal(size=(256, 6))


def _confidence(believed: PoseGaussian) -> float:
    """The probability that the true pose is within 10 cm and 30° of the mean."""
    off = _STANDARD @ np.linalg.cholesky(believed.covariance).T
    near = np.linalg.norm(off[:, :3], axis=1) < AGREEMENT_M
    return float((near & (np.linalg.norm(off[:, 3:], axis=1) < AGREEMENT_RAD)).mean())
