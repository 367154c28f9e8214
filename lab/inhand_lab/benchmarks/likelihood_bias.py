"""Measures whether the likelihood's optimum is at the truth, on rendered frames without noise.

Each object is drawn at known poses, a part of a pixel from any grid, before rooms without people;
its colours are learned from other frames with true poses, as training does, and its surroundings'
from each frame, as trackers do. Two things are measured, both for translations alone, with the true
rotation:

- where the mean of the log-likelihood over all poses is greatest, by offsets across the image and
  along the ray: over many poses the steps of single pixels are gone;
- where refinement ends, from starts off the truth: the mean over poses and starts.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.image import Image
from inhand_tracker.shape.viewpoints import find_viewpoints
from inhand_tracker.sight.appearance import learn_appearance
from inhand_tracker.sight.frame import prepare
from inhand_tracker.sight.refinement import PosePrior
from inhand_tracker.sight.sight import SIGHT_TERMS, Sight, SightTerm
from inhand_tracker.sight.view import SightView

from inhand_lab.benchmarks.parameters import DEFAULT_LIKELIHOOD_BIAS as DEFAULT
from inhand_lab.benchmarks.parameters import LikelihoodBiasParameters
from inhand_lab.benchmarks.perfect_images import PerfectCamera
from inhand_lab.geometry.transforms import Transform
from inhand_lab.objects.model import ObjectModel
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.sensing.render import object_surface
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.messages import shape_of
from inhand_lab.world.random_streams import random_stream

MM_PER_M = 1000.0
Pose = tuple[Array, Array]


@dataclass(frozen=True)
class Bias:
    """Where an optimum lies beside the truth, in millimetres: to the ``right`` and ``down`` in the
    image, and ``along`` the ray, away from the camera. NaN where there is none."""

    right_mm: float
    down_mm: float
    along_mm: float

    @property
    def across_mm(self) -> float:
        """How far it lies across the ray."""
        return float(np.hypot(self.right_mm, self.down_mm))


@dataclass(frozen=True)
class ObjectBias:
    """An object's biases: of refinement, of the whole likelihood, and of each term of it by itself,
    NaN where that says nothing."""

    name: str
    poses: int
    refined: Bias
    likelihood: Bias
    terms: dict[str, Bias]


def measure_bias(
    interactions: Sequence[str],
    advance: Callable[[], None],
    parameters: LikelihoodBiasParameters = DEFAULT,
) -> list[ObjectBias]:
    """Measure the objects of these interactions; ``advance`` is called once an object."""
    camera_random = random_stream(parameters.seed, 0, "likelihood", "rooms")
    position = np.array([0.0, parameters.camera_m, parameters.camera_height_m])
    cameras = [
        PerfectCamera.before_room(KINECT.intrinsics, parameters.finer, position, camera_random)
        for _ in range(parameters.rooms)
    ]
    results = []
    for interaction in interactions:
        results.append(_measure(INTERACTIONS[interaction].object_model(), cameras, parameters))
        advance()
    return results


def _measure(
    model: ObjectModel, cameras: Sequence[PerfectCamera], parameters: LikelihoodBiasParameters
) -> ObjectBias:
    shape, random = shape_of(model), random_stream(parameters.seed, 0, model.name, "likelihood")
    learned = learn_appearance(
        shape,
        (
            (image, *pose, None)
            for image, pose in _frames(model, cameras, parameters.learned, random, parameters)
        ),
    )
    sight = Sight(shape, find_viewpoints(shape), learned)
    curves, refined = _Curves(parameters), []
    for image, pose in _frames(model, cameras, parameters.poses, random, parameters):
        view = _view(sight, image, pose, parameters)
        curves.add(sight, view, pose)
        refined.append(_refined_offsets(sight, view, pose, random, parameters))
    return ObjectBias(
        model.name,
        parameters.poses,
        _bias(np.concatenate(refined).mean(axis=0)),
        curves.optimum(SIGHT_TERMS),
        {term: curves.optimum((term,)) for term in SIGHT_TERMS},
    )


def _frames(
    model: ObjectModel,
    cameras: Sequence[PerfectCamera],
    count: int,
    random: np.random.Generator,
    parameters: LikelihoodBiasParameters,
) -> Iterator[tuple[Image, Pose]]:
    """Draw an object at poses of any rotation, at distances evenly spread, all over the image."""
    surface, lens = object_surface(model), cameras[0].intrinsics
    middle = (model.vertices.min(axis=0) + model.vertices.max(axis=0)) / 2.0
    for number, distance in enumerate(np.linspace(*parameters.distance_m, count)):
        shares = random.uniform(parameters.margin, 1.0 - parameters.margin, 2)
        pixel, turn = shares * [lens.width, lens.height], random.normal(size=4)
        rotation = turn / np.linalg.norm(turn)
        place = lens.unproject(pixel[None], np.array([distance]))[0]
        translation = place - rotations.rotate(rotation, middle)
        pose = Transform(translation, rotations.to_matrix(rotation))
        camera = cameras[number % len(cameras)]
        image = camera.take(surface, pose, returns_depth=model.returns_depth)
        yield image, (translation, rotation)


def _view(
    sight: Sight, image: Image, pose: Pose, parameters: LikelihoodBiasParameters
) -> SightView:
    """Prepare the frame, with the colours of object and surroundings learned from it as well."""
    frame = prepare(image)
    colours = sight.learn(
        sight.start(),
        frame,
        *pose,
        of_object=parameters.object_rate,
        around=parameters.around_rate,
    )
    return sight.view(frame, colours)


class _Curves:
    """Each term's log-likelihood over all poses, by how far these are shifted: right, down and away
    from the camera."""

    def __init__(self, parameters: LikelihoodBiasParameters) -> None:
        shares = np.linspace(-1.0, 1.0, parameters.offsets)
        reaches = parameters.across_m, parameters.across_m, parameters.along_m
        self._offsets = np.outer(reaches, shares)
        self._sums = np.zeros((3, len(SIGHT_TERMS), parameters.offsets))
        self._beside_peak = parameters.beside_peak

    def add(self, sight: Sight, view: SightView, pose: Pose) -> None:
        """Add what a frame says of a pose's shifts."""
        turns = np.tile(pose[1], (self._offsets.shape[1], 1))
        for sums, offsets, way in zip(self._sums, self._offsets, _ways(pose), strict=True):
            places = pose[0] + offsets[:, None] * way
            terms = sight.log_likelihoods_by_term(places, turns, view)
            sums += np.stack([terms[term] for term in SIGHT_TERMS])

    def optimum(self, terms: Sequence[SightTerm]) -> Bias:
        """Return where the sum of some terms is greatest."""
        chosen = [SIGHT_TERMS.index(term) for term in terms]
        return _bias(
            [
                _peak(offsets, sums[chosen].sum(axis=0), self._beside_peak)
                for offsets, sums in zip(self._offsets, self._sums, strict=True)
            ]
        )


def _refined_offsets(
    sight: Sight,
    view: SightView,
    truth: Pose,
    random: np.random.Generator,
    parameters: LikelihoodBiasParameters,
) -> Array:
    """Refine starts off the truth, turned as it is; return where they end beside it, (S, 3): right,
    down and away from the camera, in metres."""
    turns = np.tile(truth[1], (parameters.starts, 1))
    shifts = random.normal(size=(parameters.starts, 3))
    shifts *= parameters.start_m / np.linalg.norm(shifts, axis=1, keepdims=True)
    places = truth[0] + shifts
    free, fixed = parameters.free_m**-2, parameters.turn_rad**-2
    most = parameters.start_m, parameters.turn_rad
    for _ in range(parameters.refinements):
        prior = PosePrior(places, turns, np.diag(np.repeat([free, fixed], 3)), most)
        moved = sight.refine(places, turns, view, prior)
        places = moved.translations
    return (places - truth[0]) @ np.stack(_ways(truth)).T


def _ways(pose: Pose) -> tuple[Array, Array, Array]:
    """Unit vectors (3,) right and down in the image, and from the camera to a pose."""
    along = pose[0] / np.linalg.norm(pose[0])
    right = np.cross([0.0, 1.0, 0.0], along)
    right /= np.linalg.norm(right)
    return right, np.cross(along, right), along


def _peak(offsets: Array, values: Array, beside: int) -> float:
    """Return where a parabola through the points beside the greatest value (N,) is greatest; NaN
    where values are all the same, or greatest at an end."""
    best = int(np.argmax(values))
    if np.ptp(values) == 0.0 or not beside <= best < len(values) - beside:
        return float("nan")
    near = slice(best - beside, best + beside + 1)
    bend, slope, _ = np.polyfit(offsets[near] - offsets[best], values[near], 2)
    return float(offsets[best] - slope / (2.0 * bend))


def _bias(offsets: Sequence[float] | Array) -> Bias:
    """Give offsets (3,) right, down and along in metres as a bias."""
    return Bias(*(MM_PER_M * float(offset) for offset in offsets))
