"""The tracker: predict, re-initialise, weigh, estimate (Darby et al. 2014, TE1 to TE5)."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inhand_tracker import rotations
from inhand_tracker.body import (
    Bases,
    RunningHeight,
    body_pose,
    has_pelvis,
    mirror_joints,
    mirror_pose,
    part_bases,
    pelvis_basis,
)
from inhand_tracker.camera import Intrinsics
from inhand_tracker.edges import chamfer_image, edge_log_weights
from inhand_tracker.estimate import LOST, Estimate, normalised_weights, weighted_estimate
from inhand_tracker.mapping import BodyPoseIndex
from inhand_tracker.methods import Method
from inhand_tracker.model_file import Model
from inhand_tracker.particles import (
    ADVANCE,
    Particles,
    draw,
    propagate,
    redraw,
    systematic_resample,
)
from inhand_tracker.viewpoints import BoundaryProjector

Array = NDArray[np.float64]

PARTICLES = 100
GAP_NS = 500_000_000
COASTING_NS = 1_000_000_000
COASTING_SPEED = 0.5
COASTING_TURN_RATE = 2.0


@dataclass(frozen=True)
class Image:
    """A luminance image (H, W) and the camera that took it."""

    grey: NDArray[np.uint8]
    camera: Intrinsics


@dataclass(frozen=True)
class _Body:
    """One frame's body, right-handed: b (60,), the 19 part predictors, and the height."""

    pose: Array
    parts: Bases
    height: float


class Tracker:
    """Follows one object of one person through the frames of one camera."""

    def __init__(
        self,
        model: Model,
        method: Method,
        *,
        left_handed: bool = False,
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
        self._random = np.random.default_rng(seed)
        self._index = BodyPoseIndex(model.mapping)
        self._projector = BoundaryProjector(model.viewpoints)
        self.restart()

    def restart(self) -> None:
        """Forget the person and the object: somebody else comes into view."""
        self._height = RunningHeight()
        self._known_pose = self._mapping.body_poses.mean(axis=0).reshape(20, 3)
        self._particles: Particles | None = None
        self._weights = np.full(self._count, 1.0 / self._count)
        self._estimate = LOST
        self._time_ns = 0

    def step(self, joints: Array | None, time_ns: int, image: Image | None = None) -> Estimate:
        """One frame: the person's joints (20, 3) in the camera frame, or None, and an image.

        Missing joints are NaN. Without an image the particles weigh the same. While the body is
        not seen the last pose stands for a second, as predicted; then the object is lost.
        """
        body = None if joints is None else self._observe(joints)
        if body is None:
            return self._coast(time_ns)
        nearest, _ = self._index.nearest(body.pose)
        if self._particles is None or not 0 < time_ns - self._time_ns <= GAP_NS:
            particles = draw(
                self._count, self._mapping, self._index, nearest, self._method, self._random
            )
        else:
            particles = self._predict(self._particles)
            if self._method.reinitialises:
                particles = redraw(
                    particles, self._mapping, self._index, nearest, self._method, self._random
                )
        translations, orientations = self._poses(particles, body)
        self._weights = self._weigh(translations, orientations, image)
        self._particles = particles
        self._time_ns = time_ns
        self._estimate = weighted_estimate(translations, orientations, self._weights)
        return self._estimate

    def outline(self, estimate: Estimate, camera: Intrinsics) -> Array | None:
        """Pixels (B, 2) of the boundary of the object at an estimate; None for a lost one."""
        if estimate.translation is None or estimate.rotation is None:
            return None
        return self._projector.project(estimate.translation[None], estimate.rotation[None], camera)[
            0
        ]

    def _observe(self, joints: Array) -> _Body | None:
        if not has_pelvis(joints):
            return None
        if self._left_handed:
            joints = mirror_joints(joints)
        height = self._height.update(joints)
        if not np.isfinite(height):
            return None
        pelvis = pelvis_basis(joints)
        seen = body_pose(joints, pelvis, height).reshape(20, 3)
        self._known_pose = np.where(np.isfinite(seen), seen, self._known_pose)
        filled = pelvis.origins + height * rotations.rotate(pelvis.rotations, self._known_pose)
        complete = np.where(np.isfinite(joints), joints, filled)
        return _Body(self._known_pose.reshape(60), part_bases(complete, pelvis), height)

    def _predict(self, particles: Particles) -> Particles:
        survivors = particles.take(systematic_resample(self._weights, self._random))
        return propagate(survivors, self._mapping, self._random, self._advance)

    def _poses(self, particles: Particles, body: _Body) -> tuple[Array, Array]:
        poses = particles.poses(self._mapping, body.parts, body.height)
        return mirror_pose(*poses, self._mirror_normal) if self._left_handed else poses

    def _weigh(self, translations: Array, orientations: Array, image: Image | None) -> Array:
        if image is None:
            return np.full(self._count, 1.0 / self._count)
        pixels = self._projector.project(translations, orientations, image.camera)
        return normalised_weights(edge_log_weights(chamfer_image(image.grey), pixels))

    def _coast(self, time_ns: int) -> Estimate:
        unseen_ns = time_ns - self._time_ns
        covariance = self._estimate.covariance
        if covariance is None or not 0 <= unseen_ns <= COASTING_NS:
            self._estimate = LOST
            return LOST
        spread = np.repeat(np.square([COASTING_SPEED, COASTING_TURN_RATE]), 3)
        return replace(
            self._estimate,
            state="predicted",
            confidence=self._estimate.confidence * (1.0 - unseen_ns / COASTING_NS),
            covariance=covariance + np.diag(spread) * (unseen_ns / 1e9) ** 2,
        )
