"""Measures the hypotheses that the tracker weighs in a second, beside NumPy one by one."""

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

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
from inhand_tracker.shape.parameters import DEFAULT_SHAPE
from inhand_tracker.shape.viewpoints import Viewpoints, find_viewpoints
from inhand_tracker.sight.frame import Region, prepare
from inhand_tracker.sight.sight import Sight

from inhand_lab.benchmarks.fusion_cost import FusionCost, measure_fusion, true_sequence
from inhand_lab.benchmarks.parameters import DEFAULT_FUSION_COST
from inhand_lab.benchmarks.parameters import DEFAULT_TRACKER_SPEED as DEFAULT
from inhand_lab.benchmarks.rendered_images import rendered_image
from inhand_lab.workers import on_one_core, usable_cores
from inhand_lab.world.messages import shape_of
from inhand_lab.world.simulation import Simulation, simulate

INTERACTION = "drinkFromMug"


@dataclass(frozen=True)
class WeighingCost:
    """Cost of a frame in which hypotheses of one object are weighed by every term.

    ``ms`` are the milliseconds to prepare the frame and weigh them in so many threads, each with a
    core; ``naive_ms`` those that NumPy takes for their published edges alone, one hypothesis after
    the other.
    """

    hypotheses: int
    threads: int
    ms: float
    naive_ms: float


@dataclass(frozen=True)
class TrackerSpeed:
    """Rates on one core at ``points`` boundary points, an image given and prepared.

    ``edge_hypotheses_per_second`` weighs poses by the published edges;
    ``full_hypotheses_per_second`` by every term of ``sight``. ``naive_ratio`` is the first over the
    rate of NumPy called for one hypothesis after the other. ``weighing`` is what frames cost in
    which many poses are weighed, ``fusion`` what its frames cost by the size of training.
    """

    edge_hypotheses_per_second: float
    points: int
    cores: int
    full_hypotheses_per_second: float
    naive_ratio: float
    weighing: tuple[WeighingCost, ...] = ()
    fusion: tuple[FusionCost, ...] = ()


def measure_tracker(
    seconds: float = DEFAULT.seconds, training_sizes: Sequence[int] = DEFAULT_FUSION_COST.sizes
) -> TrackerSpeed:
    """Measure rates on one core and costs of frames, ``seconds`` each, and then fusion's."""
    shown = simulate(INTERACTION, DEFAULT.people, DEFAULT.seed, DEFAULT.learned_frames)
    model, image = _model(), rendered_image(shown, DEFAULT.shown_frame)
    translations, orientations = _poses(model, shown, DEFAULT.hypotheses)
    edges, sight = Likelihood(model), _sight(model)
    view = sight.view(prepare(image), sight.start())

    def weigh_by_edges() -> Array:
        return edges.log_weights(translations, orientations, image)

    def weigh_fully() -> Array:
        return sight.log_likelihood(translations, orientations, view)

    def weigh_naively() -> Array:
        few = translations[: DEFAULT.naive_hypotheses], orientations[: DEFAULT.naive_hypotheses]
        return naive_edge_log_weights(*few, model.viewpoints, image)

    with on_one_core():
        edges_s, full_s, naive_s = _fastest((weigh_by_edges, weigh_fully, weigh_naively), seconds)
    edge_rate, naive_rate = DEFAULT.hypotheses / edges_s, DEFAULT.naive_hypotheses / naive_s
    return TrackerSpeed(
        edge_rate,
        DEFAULT_SHAPE.boundary_points,
        1,
        DEFAULT.hypotheses / full_s,
        edge_rate / naive_rate,
        tuple(_weighing_costs(model, shown, image, 1e3 / naive_rate, seconds)),
        measure_fusion(training_sizes),
    )


def _weighing_costs(
    model: Model, shown: Simulation, image: Image, naive_ms: float, seconds: float
) -> Iterator[WeighingCost]:
    """Time every count of hypotheses with every number of threads that there are cores for.

    ``naive_ms`` are the milliseconds that NumPy takes for one hypothesis.
    """
    threads = [count for count in DEFAULT.thread_counts if count <= usable_cores()]
    joints = shown.true_joints_in_camera[DEFAULT.shown_frame]
    for hypotheses in DEFAULT.hypothesis_counts:
        poses = _poses(model, shown, hypotheses)
        around = image.camera.project(poses[0])
        low = around.min(axis=0) - DEFAULT.region_margin_pixels
        high = around.max(axis=0) + DEFAULT.region_margin_pixels
        region = (*low.tolist(), *high.tolist())
        works = [
            partial(_weigh_frame, _sight(model, count), poses, image, region, joints)
            for count in threads
        ]
        took_s = _fastest(works, seconds / len(DEFAULT.hypothesis_counts))
        for count, fastest_s in zip(threads, took_s, strict=True):
            yield WeighingCost(hypotheses, count, 1e3 * fastest_s, naive_ms * hypotheses)


def _weigh_frame(
    sight: Sight,
    poses: tuple[Array, Array],
    image: Image,
    region: Region,
    joints: Array,
) -> None:
    frame = prepare(image, region)
    colours = sight.learn(sight.start(), frame, poses[0][0], poses[1][0], around=0.5)
    sight.log_likelihood(*poses, sight.view(frame, colours, joints))


def naive_edge_log_weights(
    translations: Array, orientations: Array, viewpoints: Viewpoints, image: Image
) -> Array:
    """Return log-weights (P,) by the published edges, one pose at a time: the ratio's reference."""
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
    people = [
        simulate(INTERACTION, person, DEFAULT.seed, DEFAULT.learned_frames)
        for person in range(DEFAULT.people)
    ]
    shape = shape_of(people[0].object_model)
    sequences = [true_sequence(one) for one in people]
    return Model(INTERACTION, shape, learn(sequences, shape.mirror_normal), find_viewpoints(shape))


def _sight(model: Model, threads: int = 1) -> Sight:
    return Sight(model.shape, model.viewpoints, model.appearance, threads=threads)


def _poses(model: Model, shown: Simulation, count: int) -> tuple[Array, Array]:
    """Return the poses (P, 3) and (P, 4) in a frame of particles from all over the training."""
    random = np.random.default_rng(DEFAULT.seed)
    frames = random.integers(len(model.mapping.body_poses), size=(2, count))
    numbers = random.integers(len(PARTS), size=(2, count))
    joints = shown.true_joints_in_camera[DEFAULT.shown_frame]
    bases = part_bases(joints, pelvis_basis(joints))
    particles = Particles(*frames, *numbers)
    return particles.poses(model.mapping, bases, shown.person.height)


def _fastest(works: Sequence[Callable[[], object]], seconds: float) -> list[float]:
    """Return the least seconds that each work took, in turns: other load can only add to it."""
    least, end = [float("inf")] * len(works), time.perf_counter() + seconds
    while time.perf_counter() < end:
        for index, work in enumerate(works):
            began = time.perf_counter()
            work()
            least[index] = min(least[index], time.perf_counter() - began)
    return least
