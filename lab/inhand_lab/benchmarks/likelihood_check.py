"""Whether the tracker's likelihood finds objects in real frames with true poses (YCB-Video).

Nothing is learned beforehand. Each object is followed through the frames from one pose that is
off, and what its colours are is learned from that pose and from where it was followed to; a frame
is tested with the colours that the frames before it taught (the first one, with those at the pose
that is off). The truth makes the starting poses and the scores only.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import find_viewpoints
from inhand_tracker.sight.colours import Colours
from inhand_tracker.sight.frame import SightFrame, prepare
from inhand_tracker.sight.refinement import PosePrior
from inhand_tracker.sight.sight import Sight
from inhand_tracker.sight.view import SightView

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.datasets.tracks import Track
from inhand_lab.evaluation.pose_errors import ErrorGauge
from inhand_lab.importers.completed_shapes import complete_box, complete_cup
from inhand_lab.importers.images import read_image
from inhand_lab.importers.ycb_shapes import model_shape, seen_points
from inhand_lab.importers.ycb_video import COLOUR_SUFFIX, DEPTH_SUFFIX, Clip, read_clips

Pose = tuple[Array, Array]

START_M, START_RAD = 0.03, np.deg2rad(10.0)
"""How far off a start is, in a direction and about an axis at random."""
STARTS = 20
SCATTER_M, SCATTER_RAD = 0.05, np.deg2rad(20.0)
"""The root mean squares of the poses that the true one is ranked among."""
SCATTERED = 10_000
LEARNING_RATE, AROUND_RATE = 0.3, 0.5
"""Share of the newest frame in the learned colours of the object and of its surroundings."""
DRAWN, REFINED = 1000, 5
"""Poses that are tried about where an object was, and those of them that are refined."""
SEED = 0


@dataclass(frozen=True)
class ObjectCheck:
    """One object in all frames. ``translation_mm`` and ``rotation_deg`` are the medians of refined
    poses' errors over frames and starts (a cup's turn about its axis does not count), ``…_90`` are
    what 90 % stay below. ``rank`` is the share of the scattered poses that are likelier than the
    true one, the median over the frames, and ``worst_rank`` the greatest."""

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
    source: Path, starts: int = STARTS, scattered: int = SCATTERED, seed: int = SEED
) -> list[ObjectCheck]:
    """Every object of a folder of YCB-Video, or of an excerpt; raises DatasetError."""
    return [
        _check(clip, name, starts, scattered, seed)
        for clip in read_clips(source)
        for name in clip.annotations[0].camera_from_objects
    ]


def whole_shape(name: str, clip: Clip) -> tuple[ObjectShape, str]:
    """An object's shape, and what it is: its ``model``, or a ``box`` or ``cup`` (without a handle)
    that fits what is seen of its surface.

    Raises DatasetError.
    """
    shape = model_shape(name, clip.folder.parent.parent)
    if shape is not None:
        return shape, "model"
    points = seen_points(name, clip.frames)
    if points is None:
        raise DatasetError(
            f"{clip.folder} tells no shape of {name}: add models/{name}/textured.obj, or a frame's "
            "-meta.mat and -label.png"
        )
    if name.endswith("_mug"):
        return complete_cup(name, points), "cup"
    return complete_box(name, points), "box"


def _check(clip: Clip, name: str, starts: int, scattered: int, seed: int) -> ObjectCheck:
    shape, kind = whole_shape(name, clip)
    sight = Sight(shape, find_viewpoints(shape))
    gauge, random = ErrorGauge(shape), np.random.default_rng(seed)
    colours = sight.start()
    followed: Pose | None = None
    moved, turned, ranks = [], [], []
    for image, truth in _frames(clip, name):
        frame = prepare(image)
        if followed is None:
            ((translation,), (rotation,)) = _off(*truth, 1, random)
            followed = (translation, rotation)
            colours = _learn(sight, colours, frame, followed)
        view = sight.view(frame, colours)
        refined = [
            _refined(sight, view, start)
            for start in zip(*_off(*truth, starts, random), strict=True)
        ]
        errors = gauge.compare(_track(refined), _track([truth] * starts))
        moved.append(errors.translation_m)
        turned.append(errors.rotation_rad)
        ranks.append(_rank(sight, view, truth, scattered, random))
        followed = _follow(sight, view, followed, random)
        colours = _learn(sight, colours, frame, followed)
    millimetres, degrees = 1e3 * np.concatenate(moved), np.rad2deg(np.concatenate(turned))
    return ObjectCheck(
        name,
        kind,
        len(ranks),
        float(np.median(millimetres)),
        float(np.quantile(millimetres, 0.9)),
        float(np.median(degrees)),
        float(np.quantile(degrees, 0.9)),
        float(np.median(ranks)),
        float(np.max(ranks)),
    )


def _frames(clip: Clip, name: str) -> Iterator[tuple[Image, Pose]]:
    for path, annotation in zip(clip.frames, clip.annotations, strict=True):
        if name not in annotation.camera_from_objects:
            continue
        colour = read_image(path.with_name(path.name + COLOUR_SUFFIX), cv2.IMREAD_COLOR_RGB)
        units = read_image(path.with_name(path.name + DEPTH_SUFFIX), cv2.IMREAD_UNCHANGED)
        matrix = annotation.camera_matrix
        camera = Intrinsics(
            float(matrix[0, 0]),
            float(matrix[1, 1]),
            float(matrix[0, 2]),
            float(matrix[1, 2]),
            colour.shape[1],
            colour.shape[0],
        )
        depth = (units / annotation.depth_divisor).astype(np.float32)
        image = Image(None, camera, depth, np.asarray(colour, np.uint8))
        yield image, annotation.camera_from_objects[name]


def _off(
    translation: Array, rotation: Array, count: int, random: np.random.Generator
) -> tuple[Array, Array]:
    """Poses exactly START_M and START_RAD off."""
    shifts, axes = _directions(count, random), _directions(count, random)
    turns = rotations.from_vector(START_RAD * axes)
    return translation + START_M * shifts, rotations.multiply(turns, rotation[None])


def _directions(count: int, random: np.random.Generator) -> Array:
    vectors = random.normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def _prior(pose: Pose) -> PosePrior:
    return PosePrior(*pose, np.diag(np.repeat([3.0 / START_M**2, 3.0 / START_RAD**2], 3)))


def _refined(sight: Sight, view: SightView, start: Pose) -> Pose:
    refined = sight.refine(start[0][None], start[1][None], view, _prior(start))
    return refined.translations[0], refined.rotations[0]


def _follow(sight: Sight, view: SightView, last: Pose, random: np.random.Generator) -> Pose:
    """As a tracker does: the best of many poses near the last one, refined."""
    prior, drawn = _prior(last), _scatter(last, DRAWN, START_M, START_RAD, random)
    likely = np.argsort(-sight.log_likelihood(*drawn, view))[:REFINED]
    refined = sight.refine(drawn[0][likely], drawn[1][likely], view, prior)
    poses = refined.translations, refined.rotations
    best = np.argmax(sight.log_likelihood(*poses, view) + prior.log_density(*poses))
    return poses[0][best], poses[1][best]


def _learn(sight: Sight, colours: Colours, frame: SightFrame, pose: Pose) -> Colours:
    return sight.learn(colours, frame, *pose, of_object=LEARNING_RATE, around=AROUND_RATE)


def _rank(
    sight: Sight,
    view: SightView,
    truth: Pose,
    scattered: int,
    random: np.random.Generator,
) -> float:
    poses = _scatter(truth, scattered, SCATTER_M, SCATTER_RAD, random)
    (reference,) = sight.log_likelihood(truth[0][None], truth[1][None], view)
    return float((sight.log_likelihood(*poses, view) > reference).mean())


def _scatter(
    pose: Pose, count: int, metres: float, radians: float, random: np.random.Generator
) -> tuple[Array, Array]:
    """Poses (P, 3) and (P, 4) about one, by root mean squares."""
    shifts, turns = random.normal(size=(2, count, 3)) / np.sqrt(3.0)
    turned = rotations.multiply(rotations.from_vector(radians * turns), pose[1][None])
    return pose[0] + metres * shifts, turned


def _track(poses: list[Pose]) -> Track:
    translations, turns = zip(*poses, strict=True)
    return Track(np.array(translations), np.array(turns))
