"""The tracker that users get: a prior from the body's motion, what it carries over, and the image.

The prior (``prior``) errs by habits: how this person holds this mug is not to be seen in a body,
but it stays as it is. So what is tracked is how the pose differs from the prior's, in the object's
own frame: what an image showed of it fades away, as learned, while the object is hidden. And an
object that was left somewhere stays there, whatever the body does. From these expectations come
hypotheses; the image weighs them (``sight``), and the likeliest are refined.
"""

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inhand_tracker import rotations
from inhand_tracker.anchors import find_anchors
from inhand_tracker.body import mirror_joints, mirror_pose
from inhand_tracker.body_reader import Body, BodyReader
from inhand_tracker.body_window import GAP_NS, BodyWindow
from inhand_tracker.camera import Intrinsics
from inhand_tracker.coasting import coasted
from inhand_tracker.estimate import (
    AGREEMENT_M,
    AGREEMENT_RAD,
    LOST,
    Estimate,
)
from inhand_tracker.image import Image
from inhand_tracker.model_file import Model, ModelError
from inhand_tracker.pose_gaussian import PoseGaussian, PoseMixture, lever, mixture
from inhand_tracker.prior import predict
from inhand_tracker.refine import Prior as RefinementPrior
from inhand_tracker.sight import SIGHT_TERMS, Sight, SightTerm, SightView
from inhand_tracker.sight_frame import prepare
from inhand_tracker.viewpoints import VisiblePoints

Array = NDArray[np.float64]

REFINED = 3
"""So many of the likeliest hypotheses."""
SEEDS, CLOSER = 20, 0.35
"""Around so many of the likeliest hypotheses as many again, so much nearer, are tried."""
TEMPER = 0.4
"""How much of an image's log-likelihood counts: one frame's errors are the next one's too."""
INDEPENDENT = 0.1
"""The same of what it says in refinement."""
SAME_M, SAME_RAD = 0.01, 0.1
"""Refined poses no farther apart than this are the same one."""

CARRIED, AFRESH, LEFT = 0.6, 0.2, 0.2
"""How likely the difference stays, is another one, or the object stays where it is."""
DOUBT = 4.0
"""By how much the prior's covariance is stretched where it speaks against what was believed."""
LEFT_DEVIATIONS = np.array([0.01, 0.01, 0.01, 0.05, 0.05, 0.05])
"""By how much an object that was left, or the camera, moves from frame to frame."""
FORGETTING_S = 0.3
"""How long what was seen makes sure of a pose: one frame errs as the next does."""
BLURRED_PIXELS = 20.0
"""An object that goes so far from frame to frame is seen half as well: its outline is a smear."""
SEEN_SCALE = 0.7
"""Of the covariance told with an image: Laplace's is too wide, on simulated people of seed 51."""
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
        search: Search = Search(),
        seed: int = 0,
    ) -> None:
        if model.prior is None:
            raise ModelError(
                f"the model of {model.shape.name} is of an older release and holds no prior: "
                "train it again, or choose another method"
            )
        self._prior = model.prior
        self._mapping = model.mapping
        self._mirror_normal = model.shape.mirror_normal
        self._left_handed = left_handed
        self._sight = Sight(model, terms) if terms else None
        if self._sight is not None:
            self._sight.compile()
        centre, normal = self._prior.centre, self._mirror_normal
        self._centre = centre - 2.0 * (centre @ normal) * normal if left_handed else centre
        self._radius = float(
            np.linalg.norm(model.shape.vertices - self._prior.centre, axis=1).max()
        )
        self._search = search
        self._seed = seed
        self._outline = VisiblePoints(model.viewpoints.directions, model.viewpoints.boundaries)
        self.restart()

    def restart(self) -> None:
        """Forget the person and the object: somebody else comes into view."""
        self._random = np.random.default_rng(self._seed)
        self._reader = self.new_reader()
        self._window = BodyWindow()
        self._colours = None if self._sight is None else self._sight.start()
        self._expected: PoseGaussian | None = None
        self._believed: PoseGaussian | None = None
        self._estimate = LOST
        self._time_ns = 0
        self.support: float | None = None

    def step(self, joints: Array | None, time_ns: int, image: Image | None = None) -> Estimate:
        """One frame: the person's joints (20, 3) in the camera frame, or None, and an image.

        Missing joints are NaN. While the body is not seen the last pose stands for a second, as
        predicted; then the object is lost.
        """
        body = None if joints is None else self._reader.read(joints)
        return self.step_body(body, time_ns, image)

    def step_body(self, body: Body | None, time_ns: int, image: Image | None = None) -> Estimate:
        """One frame, as ``step``, of a body that a reader of ``new_reader`` has read."""
        self.support = None
        if body is None:
            return self._coast(time_ns)
        expected = self._expect(body, time_ns)
        belief = self._carry(expected, time_ns)
        sharpness = self._sharpness(expected, image)
        seen = None if image is None else self._look(belief, image, body, sharpness)
        believed = belief.parts[0] if seen is None else seen
        self._expected, self._believed, self._time_ns = expected, believed, time_ns
        scale = 1.0 if seen is None else SEEN_SCALE
        self._estimate = self._estimated(replace(believed, covariance=scale * believed.covariance))
        return self._estimate

    def remember(self, body: Body, time_ns: int) -> None:
        """A frame in which the object is not looked for; what the body did before counts later."""
        self._window.add(body.joints, time_ns, body.height)

    def estimate_single_frame(self, joints: Array, image: Image | None = None) -> Estimate:
        """The object's pose in a frame by itself; what is tracked is neither used nor changed."""
        alone = FusionTracker.__new__(FusionTracker)
        alone.__dict__.update(self.__dict__)
        alone.restart()
        return alone.step(joints, 1, image)

    def outline(self, estimate: Estimate, camera: Intrinsics) -> Array | None:
        """Pixels (B, 2) of the boundary of the object at an estimate; None for a lost one."""
        if estimate.translation is None or estimate.rotation is None:
            return None
        points = self._outline.place(estimate.translation[None], estimate.rotation[None])
        return camera.project(points[0])

    def new_reader(self) -> BodyReader:
        """A reader of bodies for trackers of this model and handedness."""
        return BodyReader(self._mapping, left_handed=self._left_handed)

    def _expect(self, body: Body, time_ns: int) -> PoseGaussian:
        """What the body alone makes one expect."""
        descriptions = self._window.add(body.joints, time_ns, body.height)
        predicted = predict(self._prior, descriptions, find_anchors(body.joints), body.height)
        centre, covariance = predicted.centre, predicted.covariance
        rotation = rotations.from_matrix(predicted.rotation)
        if self._left_handed:
            # A rotation vector is mirrored as an axis is: what x keeps of it, y and z turn round.
            signs = np.array([-1.0, 1.0, 1.0, 1.0, -1.0, -1.0])
            origin = centre - rotations.rotate(rotation, self._prior.centre)
            origin, rotation = mirror_pose(origin, rotation, self._mirror_normal)
            centre = origin + rotations.rotate(rotation, self._centre)
            covariance = covariance * signs[:, None] * signs
        return PoseGaussian(centre, rotation, covariance)

    def _carry(self, expected: PoseGaussian, time_ns: int) -> PoseMixture:
        """What is expected now, after what was believed before."""
        before, believed = self._expected, self._believed
        elapsed_ns = time_ns - self._time_ns
        if (
            before is None
            or believed is None
            or not 0 < elapsed_ns <= GAP_NS
            or not self._search.carries
        ):
            return PoseMixture((expected,), np.ones(1))
        kept = float(np.exp(-elapsed_ns / 1e9 / self._prior.persistence_s))
        inverse = rotations.conjugate(before.rotation)
        moved = rotations.rotate(inverse, believed.centre - before.centre)
        turned = rotations.to_vector(rotations.multiply(inverse, believed.rotation))
        rotation = rotations.multiply(expected.rotation, rotations.from_vector(kept * turned))
        turn = rotations.multiply(rotation, rotations.conjugate(believed.rotation))
        axes = np.kron(np.eye(2), rotations.to_matrix(turn))
        sure = float(np.exp(-elapsed_ns / 1e9 / FORGETTING_S))
        carried = PoseGaussian(
            expected.centre + rotations.rotate(expected.rotation, kept * moved),
            rotation,
            sure**2 * axes @ believed.covariance @ axes.T + (1.0 - sure**2) * expected.covariance,
        )
        left = replace(
            believed, covariance=believed.covariance + np.diag(np.square(LEFT_DEVIATIONS))
        )
        parts = (carried, expected, left) if self._search.leaves else (carried, expected)
        off = np.array([expected.square_distance(part) for part in parts])
        return mixture(parts, np.log([CARRIED, AFRESH, LEFT])[: len(parts)] - 0.5 * off / DOUBT)

    def _sharpness(self, expected: PoseGaussian, image: Image | None) -> float:
        """How well an object is seen that moved to where it is expected, from 0 to 1."""
        before = self._expected
        if before is None or image is None:
            return 1.0
        ends = self._radius * np.concatenate((np.eye(3), -np.eye(3)))
        then, now = (
            image.camera.project(pose.centre + rotations.rotate(pose.rotation, ends))
            for pose in (before, expected)
        )
        way = float(np.nan_to_num(np.linalg.norm(now - then, axis=1)).max())
        return 1.0 / (1.0 + (way / BLURRED_PIXELS) ** 2)

    def _look(
        self, belief: PoseMixture, image: Image, body: Body, sharpness: float
    ) -> PoseGaussian | None:
        """What is believed after a look at the image; None where the object is out of it."""
        count = self._search.hypotheses
        centres, orientations = belief.sample(count, self._random)
        joints = mirror_joints(body.joints) if self._left_handed else body.joints
        view = self._view(centres, belief.parts[0], image, joints)
        if view is None:
            return None
        scores = self._scores(belief, centres, orientations, view, sharpness)
        root = np.linalg.cholesky(belief.moments().covariance)
        for round_ in range(1, self._search.rounds):
            best = np.resize(np.argsort(scores)[::-1][:SEEDS], count)
            shifts = CLOSER**round_ * self._random.normal(size=(count, 6)) @ root.T
            nearer = centres[best] + shifts[:, :3]
            turned = rotations.multiply(rotations.from_vector(shifts[:, 3:]), orientations[best])
            centres = np.concatenate((centres, nearer))
            orientations = np.concatenate((orientations, turned))
            scores = np.concatenate((scores, self._scores(belief, nearer, turned, view, sharpness)))
        likeliest = np.argsort(scores)[::-1][:REFINED]
        starts = [(part.centre, part.rotation) for part in belief.parts]
        starts += [(centres[index], orientations[index]) for index in likeliest]
        modes = self._modes(belief, starts, view, sharpness)
        found = self._weigh_modes(belief, modes, view, sharpness)
        self.support = self._support(modes, view, joints)
        return found.moments()

    def _scores(
        self,
        belief: PoseMixture,
        centres: Array,
        orientations: Array,
        view: SightView,
        sharpness: float,
    ) -> Array:
        """The log-posterior (P,) of poses (P, 3) and (P, 4), up to a constant."""
        sight = self._sight
        assert sight is not None
        seen = sight.log_likelihood(self._origins(centres, orientations), orientations, view)
        return TEMPER * sharpness * seen + np.logaddexp.reduce(
            belief.log_densities(centres, orientations), axis=0
        )

    def _view(
        self, centres: Array, guess: PoseGaussian, image: Image, joints: Array
    ) -> SightView | None:
        """The part of the image that hypotheses (P, 3) lie in; None where they are out of it."""
        region = self._region(centres, image.camera)
        sight, colours = self._sight, self._colours
        if region is None or sight is None or colours is None:
            return None
        frame = prepare(image, region)
        origin = self._origins(guess.centre[None], guess.rotation[None])[0]
        colours = sight.look_around(colours, frame, origin, guess.rotation, AROUND_RATE)
        self._colours = colours
        return sight.view(frame, colours, joints)

    def _region(
        self, centres: Array, camera: Intrinsics
    ) -> tuple[float, float, float, float] | None:
        pixels = camera.project(centres)
        seen = np.isfinite(pixels).all(axis=1)
        if not seen.any():
            return None
        around = 1.3 * self._radius * max(camera.fx, camera.fy) / centres[seen, 2]
        left, top = (pixels[seen] - around[:, None]).min(axis=0).tolist()
        right, bottom = (pixels[seen] + around[:, None]).max(axis=0).tolist()
        if right <= 0.0 or bottom <= 0.0 or left >= camera.width or top >= camera.height:
            return None
        return left, top, right, bottom

    def _modes(
        self,
        belief: PoseMixture,
        starts: list[tuple[Array, Array]],
        view: SightView,
        sharpness: float,
    ) -> list[PoseGaussian]:
        """Where image and belief agree best near each start; each place once."""
        sight = self._sight
        assert sight is not None
        centres = np.array([centre for centre, _ in starts])
        orientations = np.array([rotation for _, rotation in starts])
        nearest = np.argmax(belief.log_densities(centres, orientations), axis=0)
        modes: list[PoseGaussian] = []
        for index, part in enumerate(belief.parts):
            chosen = nearest == index
            if not chosen.any():
                continue
            if not self._search.refines:
                modes += [
                    PoseGaussian(*pose, part.covariance)
                    for pose in zip(centres[chosen], orientations[chosen], strict=True)
                ]
                continue
            information = np.asarray(np.linalg.inv(part.covariance), np.float64)
            refined = sight.refine(
                self._origins(centres[chosen], orientations[chosen]),
                orientations[chosen],
                view,
                self._at_origin(part, information),
                INDEPENDENT * sharpness,
            )
            for origin, turned, seen in zip(
                refined.translations, refined.rotations, refined.information, strict=True
            ):
                arm = rotations.rotate(turned, self._centre)
                back = lever(-arm)
                covariance = np.linalg.inv(information + back.T @ seen @ back)
                mode = PoseGaussian(origin + arm, turned, covariance)
                if not any(_same(mode, other) for other in modes):
                    modes.append(mode)
        return modes

    def _weigh_modes(
        self, belief: PoseMixture, modes: list[PoseGaussian], view: SightView, sharpness: float
    ) -> PoseMixture:
        """The modes by their probability (Laplace's approximation)."""
        centres = np.array([mode.centre for mode in modes])
        orientations = np.array([mode.rotation for mode in modes])
        sight = self._sight
        assert sight is not None
        expected = np.logaddexp.reduce(belief.log_densities(centres, orientations), axis=0)
        seen = sight.log_likelihood(self._origins(centres, orientations), orientations, view)
        room = np.array([0.5 * np.linalg.slogdet(mode.covariance)[1] for mode in modes])
        found = mixture(modes, expected + TEMPER * sharpness * seen + room)
        best = int(np.argmax(found.weights))
        if seen[best] > LEARNING_LOG_LIKELIHOOD and self._colours is not None:
            origin = self._origins(centres[best][None], orientations[best][None])[0]
            self._colours = sight.learn(
                self._colours, view.frame, origin, orientations[best], LEARNING_RATE
            )
        return found

    def _support(self, modes: list[PoseGaussian], view: SightView, joints: Array) -> float | None:
        """How many times likelier (log) the frame is with the object, in its colours of training:
        what was learned since may be another thing's."""
        sight, colours = self._sight, self._colours
        if sight is None or colours is None:
            return None
        trained = replace(colours, of_object=sight.start().of_object)
        view = sight.view(view.frame, trained, joints)
        orientations = np.array([mode.rotation for mode in modes])
        origins = self._origins(np.array([mode.centre for mode in modes]), orientations)
        return float(sight.log_likelihood(origins, orientations, view).max())

    def _origins(self, centres: Array, orientations: Array) -> Array:
        """The translations (P, 3) of poses whose centres are known."""
        return centres - rotations.rotate(orientations, self._centre)

    def _at_origin(self, part: PoseGaussian, information: Array) -> RefinementPrior:
        arm = rotations.rotate(part.rotation, self._centre)
        moved = lever(arm)
        return RefinementPrior(part.centre - arm, part.rotation, moved.T @ information @ moved)

    def _estimated(self, believed: PoseGaussian) -> Estimate:
        arm = rotations.rotate(believed.rotation, self._centre)
        moved = lever(-arm)
        return Estimate(
            "tracked",
            _confidence(believed),
            believed.centre - arm,
            believed.rotation,
            moved @ believed.covariance @ moved.T,
        )

    def _coast(self, time_ns: int) -> Estimate:
        predicted = coasted(self._estimate, time_ns - self._time_ns)
        if predicted.state == "lost":
            self._estimate = LOST
        return predicted


def _same(one: PoseGaussian, other: PoseGaussian) -> bool:
    apart = one.deviations(other.centre[None], other.rotation[None])[0]
    return bool(np.linalg.norm(apart[:3]) < SAME_M and np.linalg.norm(apart[3:]) < SAME_RAD)


_STANDARD = np.random.default_rng(0).normal(size=(256, 6))


def _confidence(believed: PoseGaussian) -> float:
    """The probability that the true pose is within 10 cm and 30° of the mean."""
    off = _STANDARD @ np.linalg.cholesky(believed.covariance).T
    near = np.linalg.norm(off[:, :3], axis=1) < AGREEMENT_M
    return float((near & (np.linalg.norm(off[:, 3:], axis=1) < AGREEMENT_RAD)).mean())
