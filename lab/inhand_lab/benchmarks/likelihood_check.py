"""Checks whether the likelihood finds objects in real frames with true poses (YCB-Video).

Nothing is learned beforehand. Each object is followed through the frames from one pose that is
off, and what its colours are is learned from that pose and from where it was followed to; a frame
is tested with the colours that the frames before it taught (the first one, with those at the pose
that is off). The truth makes the starting poses and the scores only.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import find_viewpoints
from inhand_tracker.sight.frame import SightFrame, prepare
from inhand_tracker.sight.refinement import PosePrior
from inhand_tracker.sight.sight import Sight
from inhand_tracker.sight.view import SightView

from inhand_lab.benchmarks.parameters import DEFAULT_LIKELIHOOD_CHECK as DEFAULT
from inhand_lab.benchmarks.parameters import LikelihoodCheckParameters
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.datasets.tracks import Track
from inhand_lab.evaluation.pose_errors import ErrorGauge
from inhand_lab.importers.completed_shapes import complete_box, complete_cup
from inhand_lab.importers.ycb_shapes import model_shape, seen_points
from inhand_lab.importers.ycb_video import Clip, read_clips, read_colour, read_depth_units

Pose = tuple[Array, Array]


@dataclass(frozen=True)
class ObjectCheck:
    """Results of one object in all frames.

    ``translation_mm`` and ``rotation_deg`` are the medians of refined poses' errors over frames and
    starts (a cup's turn about its axis does not count), ``…_90`` the errors below which 90 % stay.
    ``rank`` is the share of the scattered poses that are likelier than the true one, the median
    over the frames, and ``worst_rank`` the greatest.
    """

    name: str
    shape: str
    frames: int
    translation_mm: float
    translation_90_mm: float
    rotation_deg: float
    rotation_90_deg: float
    rank: float
    worst_rank: float


def check_likelihood(
    source: Path, parameters: LikelihoodCheckParameters = DEFAULT
) -> list[ObjectCheck]:
    """Check every object of a folder of YCB-Video, or of an excerpt; raises DatasetError."""
    return [
        _check(clip, name, parameters)
        for clip in read_clips(source)
        for name in clip.annotations[0].camera_from_objects
    ]


def whole_shape(name: str, clip: Clip) -> tuple[ObjectShape, str]:
    """Return an object's shape, and what it is; raises DatasetError.

    It is the object's ``model``, or a ``box`` or ``cup`` (without a handle) that fits what is seen
    of its surface.
    """
    shape = model_shape(name, clip.folder.parent.parent)
    if shape is not None:
        return shape, "model"
    points = seen_points(name, clip.frames)
    if points is None:
        raise DatasetError(
            f"{clip.folder} holds no shape of {name}: add models/{name}/textured.obj, or a frame's "
            "-meta.mat and -label.png"
        )
    if name.endswith("_mug"):
        return complete_cup(name, points), "cup"
    return complete_box(name, points), "box"


def _check(clip: Clip, name: str, parameters: LikelihoodCheckParameters) -> ObjectCheck:
    shape, kind = whole_shape(name, clip)
    followed = _FollowedObject(shape, parameters)
    gauge = ErrorGauge(shape)
    millimetres, degrees, ranks = [], [], []
    for image, truth in _frames(clip, name):
        refined, rank = followed.test(image, truth)
        errors = gauge.compare(_track(refined), _track([truth] * len(refined)))
        millimetres.append(1e3 * errors.translation_m)
        degrees.append(np.rad2deg(errors.rotation_rad))
        ranks.append(rank)
    return ObjectCheck(
        name,
        kind,
        len(ranks),
        *_median_and_90(millimetres),
        *_median_and_90(degrees),
        float(np.median(ranks)),
        float(np.max(ranks)),
    )


def _median_and_90(errors: list[Array]) -> tuple[float, float]:
    together = np.concatenate(errors)
    return float(np.median(together)), float(np.quantile(together, 0.9))


class _FollowedObject:
    """An object that is followed from frame to frame, and whose colours are learned on the way."""

    def __init__(self, shape: ObjectShape, parameters: LikelihoodCheckParameters) -> None:
        self._sight = Sight(shape, find_viewpoints(shape))
        self._parameters = parameters
        self._random = np.random.default_rng(parameters.seed)
        self._colours = self._sight.start()
        self._pose: Pose | None = None

    def test(self, image: Image, truth: Pose) -> tuple[list[Pose], float]:
        """Refine starts near the truth, and rank it, with what the frames before have taught.

        Returns the refined poses and the share of scattered poses that are likelier than the true
        one.
        """
        frame = prepare(image)
        if self._pose is None:
            (self._pose,) = self._starts(truth, 1)
            self._learn(frame, self._pose)
        view = self._sight.view(frame, self._colours)
        starts = self._starts(truth, self._parameters.starts)
        refined = [self._refine(view, start) for start in starts]
        rank = self._rank(view, truth)
        self._pose = self._follow(view, self._pose)
        self._learn(frame, self._pose)
        return refined, rank

    def _starts(self, truth: Pose, count: int) -> list[Pose]:
        """Draw poses exactly ``start_m`` and ``start_rad`` off the truth."""
        shifts, axes = _directions(count, self._random), _directions(count, self._random)
        turns = rotations.from_vector(self._parameters.start_rad * axes)
        translations = truth[0] + self._parameters.start_m * shifts
        return list(zip(translations, rotations.multiply(turns, truth[1][None]), strict=True))

    def _prior(self, pose: Pose) -> PosePrior:
        variances = (self._parameters.start_m**2, self._parameters.start_rad**2)
        return PosePrior(*pose, np.diag(np.repeat([3.0 / one for one in variances], 3)))

    def _refine(self, view: SightView, start: Pose) -> Pose:
        refined = self._sight.refine(start[0][None], start[1][None], view, self._prior(start))
        return refined.translations[0], refined.rotations[0]

    def _follow(self, view: SightView, last: Pose) -> Pose:
        """Find the best of many poses near the last one, refined, as a tracker does."""
        sight, parameters, prior = self._sight, self._parameters, self._prior(last)
        drawn = _scatter(
            last, parameters.drawn, parameters.start_m, parameters.start_rad, self._random
        )
        likely = np.argsort(-sight.log_likelihood(*drawn, view))[: parameters.refined]
        refined = sight.refine(drawn[0][likely], drawn[1][likely], view, prior)
        poses = refined.translations, refined.rotations
        best = np.argmax(sight.log_likelihood(*poses, view) + prior.log_density(*poses))
        return poses[0][best], poses[1][best]

    def _learn(self, frame: SightFrame, pose: Pose) -> None:
        self._colours = self._sight.learn(
            self._colours,
            frame,
            *pose,
            of_object=self._parameters.object_rate,
            around=self._parameters.around_rate,
        )

    def _rank(self, view: SightView, truth: Pose) -> float:
        parameters = self._parameters
        poses = _scatter(
            truth, parameters.scattered, parameters.scatter_m, parameters.scatter_rad, self._random
        )
        (reference,) = self._sight.log_likelihood(truth[0][None], truth[1][None], view)
        return float((self._sight.log_likelihood(*poses, view) > reference).mean())


def _frames(clip: Clip, name: str) -> Iterator[tuple[Image, Pose]]:
    for path, annotation in zip(clip.frames, clip.annotations, strict=True):
        if name not in annotation.camera_from_objects:
            continue
        colour, units = read_colour(path), read_depth_units(path)
        (fx, _, cx), (_, fy, cy), _ = annotation.camera_matrix.tolist()
        camera = Intrinsics(fx, fy, cx, cy, colour.shape[1], colour.shape[0])
        depth = (units / annotation.depth_divisor).astype(np.float32)
        image = Image(None, camera, depth, np.asarray(colour, np.uint8))
        yield image, annotation.camera_from_objects[name]


def _directions(count: int, random: np.random.Generator) -> Array:
    vectors = random.normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def _scatter(
    pose: Pose, count: int, metres: float, radians: float, random: np.random.Generator
) -> tuple[Array, Array]:
    """Draw poses (P, 3) and (P, 4) about one, by root mean squares."""
    shifts, turns = random.normal(size=(2, count, 3)) / np.sqrt(3.0)
    turned = rotations.multiply(rotations.from_vector(radians * turns), pose[1][None])
    return pose[0] + metres * shifts, turned


def _track(poses: list[Pose]) -> Track:
    translations, turns = zip(*poses, strict=True)
    return Track(np.array(translations), np.array(turns))
