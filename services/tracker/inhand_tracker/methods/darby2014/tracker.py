"""The tracker: predict, re-initialise, weigh, estimate (Darby et al. 2014, TE1 to TE5)."""

from collections.abc import Collection

import numpy as np

from inhand_tracker.body.reader import Body, BodyReader
from inhand_tracker.body.skeleton import mirror_pose
from inhand_tracker.geometry.ageing import coasted
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.estimate import LOST, Estimate, normalised_weights, weighted_estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.mapping.mapping import BodyPoseIndex
from inhand_tracker.methods.darby2014.likelihood import DEFAULT_TERMS, Likelihood, Term
from inhand_tracker.methods.darby2014.nothing_near import draw_broadly, farthest_near
from inhand_tracker.methods.darby2014.particles import (
    ADVANCE,
    Particles,
    draw,
    mixing_fractions,
    propagate,
    redraw,
    systematic_resample,
)
from inhand_tracker.methods.darby2014.variants import Variant
from inhand_tracker.model.model import Model
from inhand_tracker.shape.viewpoints import VisiblePoints
from inhand_tracker.sight.support import Support

PARTICLES = 100
GAP_NS = 500_000_000


class ParticleTracker:
    """Follows one object of one person through the frames of one camera."""

    def __init__(
        self,
        model: Model,
        method: Variant,
        *,
        left_handed: bool = False,
        terms: Collection[Term] = DEFAULT_TERMS,
        particles: int = PARTICLES,
        seed: int = 0,
        advance: float = ADVANCE,
    ) -> None:
        self._mapping = model.mapping
        self._mirror_normal = model.shape.mirror_normal
        self._method = method
        self._left_handed = left_handed
        self._count = particles
        self._advance = advance
        self._seed = seed
        self._random = np.random.default_rng(seed)
        self._index = BodyPoseIndex(model.mapping)
        self._farthest_near = farthest_near(model.mapping) if method.falls_back else np.inf
        self._likelihood = Likelihood(model, terms)
        self._outline = VisiblePoints(model.viewpoints.directions, model.viewpoints.boundaries)
        self.restart()

    def restart(self) -> None:
        """Forget the person and the object: somebody else comes into view."""
        self._reader = self.new_reader()
        self._particles: Particles | None = None
        self._weights = np.full(self._count, 1.0 / self._count)
        self._estimate = LOST
        self._time_ns = 0
        self.support: Support | None = None

    def step(self, joints: Array | None, time_ns: int, image: Image | None = None) -> Estimate:
        """One frame: the person's joints (20, 3) in the camera frame, or None, and an image.

        Missing joints are NaN. Without an image the particles weigh the same. While the body is
        not seen the last pose stands for a second, as predicted; then the object is lost.
        """
        body = None if joints is None else self._reader.read(joints)
        return self.step_body(body, time_ns, image)

    def step_body(self, body: Body | None, time_ns: int, image: Image | None = None) -> Estimate:
        """One frame, as ``step``, of a body that a reader of ``new_reader`` has read."""
        if body is None:
            return self._coast(time_ns)
        particles = self._reinitialise(self._predict(time_ns), body)
        translations, orientations = self._place(particles, body)
        weights = self._weigh(translations, orientations, image)
        self._particles, self._weights, self._time_ns = particles, weights, time_ns
        self._estimate = weighted_estimate(translations, orientations, weights)
        return self._estimate

    def remember(self, body: Body, time_ns: int) -> None:
        """A frame in which the object is not looked for: what the body did before says nothing."""

    def estimate_single_frame(self, joints: Array, image: Image | None = None) -> Estimate:
        """The object's pose in a frame by itself: every particle is discriminative (section 7).

        ``joints`` (20, 3) as in ``step``; what is tracked is neither used nor changed.
        """
        body = self.new_reader().read(joints)
        if body is None:
            return LOST
        random = np.random.default_rng(self._seed)
        fresh = self._draw(body, *self._index.nearest(body.pose), random)
        translations, orientations = self._place(fresh, body)
        weights = self._weigh(translations, orientations, image)
        return weighted_estimate(translations, orientations, weights)

    def outline(self, estimate: Estimate, camera: Intrinsics) -> Array | None:
        """Pixels (B, 2) of the boundary of the object at an estimate; None for a lost one."""
        if estimate.translation is None or estimate.rotation is None:
            return None
        points = self._outline.place(estimate.translation[None], estimate.rotation[None])
        return camera.project(points[0])

    def new_reader(self) -> BodyReader:
        """A reader of bodies for trackers of this model and handedness."""
        return BodyReader(self._mapping, left_handed=self._left_handed)

    def _predict(self, time_ns: int) -> Particles | None:
        """The particles a frame on; None at first and after a gap."""
        if self._particles is None or not 0 < time_ns - self._time_ns <= GAP_NS:
            return None
        survivors = self._particles.take(systematic_resample(self._weights, self._random))
        return propagate(survivors, self._mapping, self._random, self._advance)

    def _reinitialise(self, particles: Particles | None, body: Body) -> Particles:
        if particles is not None and not self._method.reinitialises:
            return particles
        nearest, distance = self._index.nearest(body.pose)
        fresh = self._draw(body, nearest, distance, self._random)
        if particles is None:
            return fresh
        return redraw(particles, fresh, mixing_fractions(self._mapping, nearest), self._random)

    def _draw(
        self, body: Body, nearest: int, distance: float, random: np.random.Generator
    ) -> Particles:
        if distance > self._farthest_near:
            return draw_broadly(self._count, self._mapping, body.pose, self._method, random)
        return draw(self._count, self._mapping, self._index, nearest, self._method, random)

    def _place(self, particles: Particles, body: Body) -> tuple[Array, Array]:
        """The particles' poses in the camera frame, (P, 3) and (P, 4)."""
        poses = particles.poses(self._mapping, body.parts, body.height)
        return mirror_pose(*poses, self._mirror_normal) if self._left_handed else poses

    def _weigh(self, translations: Array, orientations: Array, image: Image | None) -> Array:
        if image is None:
            return np.full(self._count, 1.0 / self._count)
        return normalised_weights(self._likelihood.log_weights(translations, orientations, image))

    def _coast(self, time_ns: int) -> Estimate:
        predicted = coasted(self._estimate, time_ns - self._time_ns)
        if predicted.state == "lost":
            self._estimate = LOST
        return predicted
