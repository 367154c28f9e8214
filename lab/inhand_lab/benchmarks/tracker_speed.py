"""How many hypotheses the tracker weighs in a second, beside a plain evaluation one by one."""

import os
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import product

import numpy as np
from inhand_tracker.body.skeleton import PARTS, part_bases, pelvis_basis
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.image import Image
from inhand_tracker.mapping.learning import learn
from inhand_tracker.methods.darby2014.edges import chamfer_of
from inhand_tracker.methods.darby2014.likelihood import Likelihood
from inhand_tracker.methods.darby2014.particles import Particles
from inhand_tracker.model.model import Model
from inhand_tracker.shape.viewpoints import BOUNDARY_POINTS, Viewpoints, find_viewpoints
from inhand_tracker.sight.frame import Region, prepare
from inhand_tracker.sight.sight import Sight

from inhand_lab.benchmarks.fusion_cost import SIZES, FusionCost, measure_fusion, true_sequence
from inhand_lab.benchmarks.rendered_images import rendered_image
from inhand_lab.workers import usable_cores
from inhand_lab.world.messages import shape_of
from inhand_lab.world.simulation import Simulation, simulate

INTERACTION = "drinkFromMug"
SEED = 0
PEOPLE = 2
LEARNED_FRAMES = 120
SHOWN_FRAME = 60
HYPOTHESES = 1000
NAIVE_HYPOTHESES = 100
SECONDS = 6.0
FRAME_CORES = 2
HYPOTHESIS_COUNTS = (100, 1_000, 10_000)
OBJECT_COUNTS = (1, 2, 4)
REGION_MARGIN = 60.0


@dataclass(frozen=True)
class FrameCost:
    """Milliseconds on ``cores`` cores to prepare a frame and to weigh so many hypotheses of each of
    so many objects by every term; ``naive_ms``, what NumPy takes for their published edges alone,
    one hypothesis after the other."""

    objects: int
    hypotheses: int
    cores: int
    ms: float
    naive_ms: float


@dataclass(frozen=True)
class TrackerSpeed:
    """Rates on one core at ``points`` boundary points, an image given and prepared.

    ``edge_hypotheses_per_second`` weighs poses by the published edges;
    ``full_hypotheses_per_second`` by every term of ``sight``. ``naive_ratio`` is the first over the
    rate of NumPy called for one hypothesis after the other. ``frames`` is what whole frames cost,
    ``fusion`` what its frames cost by the size of training.
    """

    edge_hypotheses_per_second: float
    points: int
    cores: int
    full_hypotheses_per_second: float
    naive_ratio: float
    frames: tuple[FrameCost, ...] = ()
    fusion: tuple[FusionCost, ...] = ()


def measure_tracker(
    seconds: float = SECONDS, training_sizes: Sequence[int] = SIZES
) -> TrackerSpeed:
    """Measure rates for so many seconds, on one core, and then what is learned of each size."""
    shown = simulate(INTERACTION, PEOPLE, SEED, LEARNED_FRAMES)
    model, image = _model(), rendered_image(shown, SHOWN_FRAME)
    translations, orientations = _poses(model, shown, HYPOTHESES)
    edges, sight = Likelihood(model), _sight(model)
    view = sight.view(prepare(image), sight.start())

    def weigh_by_edges() -> Array:
        return edges.log_weights(translations, orientations, image)

    def weigh_fully() -> Array:
        return sight.log_likelihood(translations, orientations, view)

    def weigh_naively() -> Array:
        few = translations[:NAIVE_HYPOTHESES], orientations[:NAIVE_HYPOTHESES]
        return naive_edge_log_weights(*few, model.viewpoints, image)

    with _one_core():
        edges_s, full_s, naive_s = _fastest((weigh_by_edges, weigh_fully, weigh_naively), seconds)
    edge_rate, naive_rate = HYPOTHESES / edges_s, NAIVE_HYPOTHESES / naive_s
    return TrackerSpeed(
        edge_rate,
        BOUNDARY_POINTS,
        1,
        HYPOTHESES / full_s,
        edge_rate / naive_rate,
        tuple(_frame_costs(model, shown, image, 1e3 / naive_rate, seconds)),
        measure_fusion(training_sizes),
    )


def _frame_costs(
    model: Model, shown: Simulation, image: Image, naive_ms: float, seconds: float
) -> Iterator[FrameCost]:
    """Every count of hypotheses with every count of objects, which here are all the same one.

    ``naive_ms`` is what NumPy takes for one hypothesis.
    """
    cores = min(FRAME_CORES, usable_cores())
    objects = [_sight(model, cores) for _ in range(max(OBJECT_COUNTS))]
    joints = shown.true_joints_in_camera[SHOWN_FRAME]
    for hypotheses, count in product(HYPOTHESIS_COUNTS, OBJECT_COUNTS):
        poses = _poses(model, shown, hypotheses)
        around = image.camera.project(poses[0])
        low, high = around.min(axis=0) - REGION_MARGIN, around.max(axis=0) + REGION_MARGIN

        region = (*low.tolist(), *high.tolist())
        weigh_frame = partial(_weigh_frame, objects[:count], poses, image, region, joints)
        share = seconds / (len(HYPOTHESIS_COUNTS) * len(OBJECT_COUNTS))
        (took_s,) = _fastest((weigh_frame,), share)
        yield FrameCost(count, hypotheses, cores, 1e3 * took_s, naive_ms * hypotheses * count)


def _weigh_frame(
    objects: Sequence[Sight],
    poses: tuple[Array, Array],
    image: Image,
    region: Region,
    joints: Array,
) -> None:
    frame = prepare(image, region)
    for sight in objects:
        colours = sight.learn(sight.start(), frame, poses[0][0], poses[1][0], around=0.5)
        sight.log_likelihood(*poses, sight.view(frame, colours, joints))


def naive_edge_log_weights(
    translations: Array, orientations: Array, viewpoints: Viewpoints, image: Image
) -> Array:
    """What the edge likelihood is, (P,), one pose at a time: the reference of the ratio."""
    chamfer, camera = image.once(chamfer_of), image.camera
    if chamfer is None:
        raise ValueError("the image has no luminance")
    log_weights = np.empty(len(translations))
    for index, (translation, orientation) in enumerate(
        zip(translations, orientations, strict=True)
    ):
        turn = rotations.to_matrix(orientation)
        view = np.argmax(viewpoints.directions @ (turn.T @ -translation))
        points = viewpoints.boundaries[view] @ turn.T + translation
        pixels = np.rint(camera.project(points))
        inside = np.all((pixels >= 0) & (pixels < [camera.width, camera.height]), axis=1)
        nearness = np.zeros(len(points))
        column, row = pixels[inside].astype(int).T
        nearness[inside] = chamfer[row, column]
        log_weights[index] = -np.square(1.0 - nearness).mean()
    return log_weights


def _model() -> Model:
    people = [simulate(INTERACTION, person, SEED, LEARNED_FRAMES) for person in range(PEOPLE)]
    shape = shape_of(people[0].object_model)
    sequences = [true_sequence(one) for one in people]
    return Model(INTERACTION, shape, learn(sequences, shape.mirror_normal), find_viewpoints(shape))


def _sight(model: Model, threads: int = 1) -> Sight:
    return Sight(model.shape, model.viewpoints, model.appearance, threads=threads)


def _poses(model: Model, shown: Simulation, count: int) -> tuple[Array, Array]:
    """Poses (P, 3) and (P, 4) that particles all over the training frames have in the frame."""
    random = np.random.default_rng(SEED)
    frames = random.integers(len(model.mapping.body_poses), size=(2, count))
    numbers = random.integers(len(PARTS), size=(2, count))
    joints = shown.true_joints_in_camera[SHOWN_FRAME]
    bases = part_bases(joints, pelvis_basis(joints))
    particles = Particles(*frames, *numbers)
    return particles.poses(model.mapping, bases, shown.person.height)


def _fastest(works: Sequence[Callable[[], object]], seconds: float) -> list[float]:
    """The least seconds that each took, in turns: what else the machine does only ever adds."""
    least, end = [float("inf")] * len(works), time.perf_counter() + seconds
    while time.perf_counter() < end:
        for index, work in enumerate(works):
            began = time.perf_counter()
            work()
            least[index] = min(least[index], time.perf_counter() - began)
    return least


@contextmanager
def _one_core() -> Iterator[None]:
    usable = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(usable)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, usable)
