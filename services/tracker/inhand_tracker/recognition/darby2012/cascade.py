"""Cascade recognition and hierarchical importance sampling (Darby et al. 2012).

The object is not given: a classifier of body poses says which actions are likely, and particles
search action and object pose together.
"""

from collections.abc import Sequence

import numpy as np

from inhand_tracker.body.convention_table import shared_convention
from inhand_tracker.body.reader import Body
from inhand_tracker.body.skeleton import Bases, mirror_pose
from inhand_tracker.body.window import continues
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.estimate import LOST, Estimate, weighted_estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.geometry.weights import normalised_weights
from inhand_tracker.methods.darby2014.edges import chamfer_of, edge_log_weights
from inhand_tracker.methods.darby2014.parameters import DEFAULT_DARBY2014
from inhand_tracker.model.model import Model
from inhand_tracker.recognition.darby2012.action_particles import (
    ActionParticles,
    TrainingPoses,
    corrections,
    draw_particles,
    join_particles,
    likeliest_actions,
    move_particles,
)
from inhand_tracker.recognition.darby2012.parameters import DEFAULT_DARBY2012, Darby2012Parameters
from inhand_tracker.recognition.object_recogniser import ObjectRecogniser
from inhand_tracker.recognition.recogniser import Recogniser
from inhand_tracker.recognition.recognition import Recognition, outline_boxes, recognised_action
from inhand_tracker.shape.visible_points import VisiblePoints


class Cascade2012(ObjectRecogniser):
    """Follows whatever one person uses, of ``models`` in the order of the recogniser's actions.

    Without an image the particles weigh as they were drawn.
    """

    def __init__(
        self,
        recogniser: Recogniser,
        models: Sequence[Model],
        *,
        left_handed: bool = False,
        particles: int = DEFAULT_DARBY2014.particles,
        seed: int = 0,
        parameters: Darby2012Parameters = DEFAULT_DARBY2012,
    ) -> None:
        super().__init__(
            recogniser,
            len(models),
            left_handed=left_handed,
            learned_as=shared_convention(model.mapping.convention for model in models),
        )
        self._svm = recogniser.svm
        self._models = models
        self._poses = [TrainingPoses(m.mapping.body_poses.astype(np.float32)) for m in models]
        self._outlines = [
            VisiblePoints(m.viewpoints.directions, m.viewpoints.boundaries) for m in models
        ]
        self._count = particles
        self._random = np.random.default_rng(seed)
        self._parameters = parameters
        self.restart()

    def restart(self) -> None:
        """Forget the person and the object: somebody else comes into view."""
        super().restart()
        self._particles: ActionParticles | None = None
        self._time_ns = 0

    def _recognise(
        self, body: Body, time_ns: int, image: Image | None, camera: Intrinsics | None
    ) -> Recognition:
        particles = self._propose(body, time_ns)
        translations, orientations = self._place(particles, body)
        logs, boxes = self._see(particles, translations, orientations, image, camera)
        with np.errstate(divide="ignore"):
            weights = normalised_weights(np.log(particles.weights) + logs)
        self._particles = join_particles([particles], weights)
        self._time_ns = time_ns
        masses = np.bincount(particles.actions, weights, len(self._models)).astype(float)
        known = recognised_action(masses)
        estimate = LOST
        if known is not None:
            ours = particles.actions == known
            estimate = _expected(translations[ours], orientations[ours], weights[ours])
        return Recognition(masses, known, estimate, _mean_box(boxes, weights))

    def _without_body(self, time_ns: int, image: Image | None) -> Recognition:
        return Recognition(self._last.probabilities, None, LOST, self._last.box)

    def _propose(self, body: Body, time_ns: int) -> ActionParticles:
        """Propose particles, whose weights hold the correction of the importance particles."""
        memberships = self._svm.probabilities(body.pose[None])[0]
        shares = likeliest_actions(memberships, self._parameters.top_mass)
        before = self._particles
        if before is None or not continues(self._time_ns, time_ns):
            return draw_particles(self._count, shares, body.pose, self._poses, self._random)
        acting, important, initial = self._random.multinomial(
            self._count, self._parameters.particle_shares
        )
        generated = move_particles(before, acting, self._poses, self._random, self._parameters)
        importance = draw_particles(important, shares, body.pose, self._poses, self._random)
        initialisers = draw_particles(initial, shares, body.pose, self._poses, self._random)
        weights = np.ones(self._count)
        weights[acting : acting + important] = corrections(
            importance, shares, before, self._poses, self._parameters
        )
        return join_particles([generated, importance, initialisers], weights)

    def _place(self, particles: ActionParticles, body: Body) -> tuple[Array, Array]:
        """Place the particles in the camera frame: poses (P, 3) and (P, 4)."""
        translations, orientations = np.empty((self._count, 3)), np.empty((self._count, 4))
        for action in np.unique(particles.actions):
            ours = particles.actions == action
            frames, parts = particles.frames[ours], particles.parts[ours]
            mapping = self._models[action].mapping
            bases = Bases(body.parts.origins[parts], body.parts.rotations[parts])
            poses = bases.to_camera(
                mapping.translations[frames, parts] * body.height, mapping.rotations[frames, parts]
            )
            if self._left_handed:
                poses = mirror_pose(*poses, self._models[action].shape.mirror_normal)
            translations[ours], orientations[ours] = poses
        return translations, orientations

    def _see(
        self,
        particles: ActionParticles,
        translations: Array,
        orientations: Array,
        image: Image | None,
        camera: Intrinsics | None,
    ) -> tuple[Array, Array]:
        """The particles' log-likelihoods (P,) and boxes in the image (P, 4)."""
        logs, boxes = np.zeros(self._count), np.full((self._count, 4), np.nan)
        if camera is None:
            return logs, boxes
        for action in np.unique(particles.actions):
            ours = particles.actions == action
            placed = self._outlines[action].place(translations[ours], orientations[ours])
            pixels = camera.project(placed)
            boxes[ours] = outline_boxes(pixels)
            chamfer = None if image is None else image.once(chamfer_of)
            if chamfer is not None:
                logs[ours] = edge_log_weights(chamfer, pixels)
        return logs, boxes


def _expected(translations: Array, orientations: Array, weights: Array) -> Estimate:
    return weighted_estimate(translations, orientations, weights / weights.sum())


def _mean_box(boxes: Array, weights: Array) -> Array | None:
    seen = np.isfinite(boxes).all(axis=1) & (weights > 0.0)
    if not seen.any():
        return None
    return np.asarray(weights[seen] @ boxes[seen] / weights[seen].sum())
