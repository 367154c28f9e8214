"""The tracker: predict, re-initialise, weigh, estimate (Darby et al. 2014, TE1 to TE5)."""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from inhand_tracker.body.reader import Body, BodyReader
from inhand_tracker.body.skeleton import PARTS, mirror_pose
from inhand_tracker.body.window import continues
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.considered import Considered
from inhand_tracker.geometry.estimate import Estimate, weighted_estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.geometry.weights import even_weights, normalised_weights, systematic_resample
from inhand_tracker.mapping.body_pose_index import BodyPoseIndex
from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.methods.darby2014.likelihood import Likelihood
from inhand_tracker.methods.darby2014.nothing_near import draw_broadly, farthest_near
from inhand_tracker.methods.darby2014.parameters import DEFAULT_DARBY2014, Darby2014Parameters
from inhand_tracker.methods.darby2014.particles import (
    Particles,
    draw,
    mixing_fractions,
    propagate,
    redraw,
)
from inhand_tracker.methods.darby2014.terms import DEFAULT_TERMS, Term
from inhand_tracker.methods.darby2014.variants import Variant
from inhand_tracker.methods.follower import Follower, FollowingTracker
from inhand_tracker.model.model import Model


class ParticleTracker(FollowingTracker):
    """Follows one object of one person through the frames of one camera.

    Without an image the particles weigh the same. A single frame's particles are all
    discriminative (section 7).
    """

    def __init__(
        self,
        model: Model,
        method: Variant,
        *,
        left_handed: bool = False,
        terms: Collection[Term] = DEFAULT_TERMS,
        parameters: Darby2014Parameters = DEFAULT_DARBY2014,
        seed: int = 0,
    ) -> None:
        super().__init__(model, left_handed=left_handed)
        self._object = _LearnedObject(
            model.mapping,
            BodyPoseIndex(model.mapping),
            farthest_near(model.mapping, parameters) if method.falls_back else np.inf,
            Likelihood(model, terms),
            method,
            parameters,
            model.shape.mirror_normal if left_handed else None,
        )
        self._seed = seed
        self._random = np.random.default_rng(seed)
        self.restart()

    def _start(self, *, alone: bool) -> Follower:
        random = np.random.default_rng(self._seed) if alone else self._random
        return ParticleFollower(self._object, random, self.new_reader())


@dataclass(frozen=True)
class _LearnedObject:
    """What all followers of a tracker share.

    No training pose farther away than ``farthest_near`` counts as near. ``mirror_normal`` (3,) is
    the object's for left-handed people, None for others.
    """

    mapping: Mapping
    index: BodyPoseIndex
    farthest_near: float
    likelihood: Likelihood
    method: Variant
    parameters: Darby2014Parameters
    mirror_normal: Array | None


class ParticleFollower(Follower):
    """Follows one object of one person, from when they came into view."""

    def __init__(
        self, tracked: _LearnedObject, random: np.random.Generator, reader: BodyReader
    ) -> None:
        super().__init__(reader)
        self._object = tracked
        self._random = random
        self._particles: Particles | None = None
        self._weights = even_weights(tracked.parameters.particles)
        self._last: tuple[Body, tuple[Array, Array]] | None = None

    def estimate(self, body: Body, time_ns: int, image: Image | None) -> Estimate:
        particles = self._reinitialise(self._predict(time_ns), body)
        poses = self._place(particles, body)
        weights = self._weigh(poses, image)
        self._particles, self._weights, self._last = particles, weights, (body, poses)
        return weighted_estimate(*poses, weights)

    def considered(self) -> Considered | None:
        if self._last is None:
            return None
        body, poses = self._last
        nearest, _ = self._object.index.nearest(body.pose)
        parts = np.arange(len(PARTS))
        frames = np.full(len(PARTS), nearest)
        translations, orientations = self._place(Particles(frames, frames, parts, parts), body)
        predictions = {
            part: (translations[number], orientations[number]) for number, part in enumerate(PARTS)
        }
        return Considered(*poses, self._weights, predictions)

    def remember(self, body: Body, time_ns: int) -> None:
        """Take nothing: what the body did before says nothing here."""

    def _predict(self, time_ns: int) -> Particles | None:
        """The particles a frame on; None at first and after a gap."""
        if self._particles is None or not continues(self._time_ns, time_ns):
            return None
        survivors = self._particles.take(systematic_resample(self._weights, self._random))
        return propagate(survivors, self._object.mapping, self._random, self._object.parameters)

    def _reinitialise(self, particles: Particles | None, body: Body) -> Particles:
        """The particles with some, or all where there are none, drawn for this body pose."""
        tracked = self._object
        if particles is not None and not tracked.method.reinitialises:
            return particles
        nearest, distance = tracked.index.nearest(body.pose)
        fresh = self._draw(body, nearest, distance)
        if particles is None:
            return fresh
        fractions = mixing_fractions(tracked.mapping, nearest, tracked.parameters)
        return redraw(particles, fresh, fractions, self._random)

    def _draw(self, body: Body, nearest: int, distance: float) -> Particles:
        tracked, random = self._object, self._random
        if distance > tracked.farthest_near:
            return draw_broadly(
                tracked.mapping, body.pose, tracked.method, random, tracked.parameters
            )
        count = tracked.parameters.particles
        return draw(count, tracked.mapping, tracked.index, nearest, tracked.method, random)

    def _place(self, particles: Particles, body: Body) -> tuple[Array, Array]:
        """The particles' poses in the camera frame, (P, 3) and (P, 4)."""
        poses = particles.poses(self._object.mapping, body.parts, body.height)
        normal = self._object.mirror_normal
        return poses if normal is None else mirror_pose(*poses, normal)

    def _weigh(self, poses: tuple[Array, Array], image: Image | None) -> Array:
        if image is None:
            return even_weights(len(poses[0]))
        return normalised_weights(self._object.likelihood.log_weights(*poses, image))
