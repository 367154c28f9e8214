"""Measures what learning and asking cost from 10,000 to a million labelled frames.

The frames are simulated people who drink from a mug, each six times, as a skeleton tracker saw
them: bodies, movement and noise that differ as people's do. Every size is the beginning of the
next one. Each is learned in a fresh process, whose peak of memory counts, and asked in another one
for the body poses of somebody who was not learned.
"""

import resource
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import TypeVar

import numpy as np
from inhand_tracker.body.skeleton import (
    body_pose,
    pelvis_basis,
    stature_of,
)
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.mapping.body_pose_index import BodyPoseIndex
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.learning import learn
from inhand_tracker.model.model import Model
from inhand_tracker.model.model_file import load_model, save_model
from inhand_tracker.shape.viewpoints import find_viewpoints
from scipy.spatial.distance import cdist

from inhand_lab.benchmarks.parameters import DEFAULT_TRAINING_COST as DEFAULT
from inhand_lab.workers import in_processes
from inhand_lab.world.messages import shape_of
from inhand_lab.world.simulation import simulate

Asked = TypeVar("Asked")
Result = TypeVar("Result")

INTERACTION = "drinkFromMug"
MODEL = "mug.model"


@dataclass(frozen=True)
class Percentiles:
    """Percentiles of the milliseconds that single calls took."""

    p50: float
    p99: float


@dataclass(frozen=True)
class Learning:
    """Cost of learning and saving; memory is the peak of the process, all included."""

    frames: int
    recordings: int
    training_s: float
    training_cpu_s: float
    peak_memory_mb: float
    model_mb: float
    save_s: float


@dataclass(frozen=True)
class Asking:
    """Cost of loading and asking.

    ``linear_ms`` is the median of SciPy's ``cdist`` over all frames, the reference of the same
    run, and ``found`` the share of body poses for which the search is as near as it.
    """

    load_s: float
    index_s: float
    nearest_ms: Percentiles
    cluster_ms: Percentiles
    linear_ms: float
    found: float


@dataclass(frozen=True)
class TrainingCost:
    """Cost of one size of training."""

    learning: Learning
    asking: Asking


def training_steps(sizes: Sequence[int]) -> dict[str, int]:
    """Return the stages that the benchmark goes through, each with the number of its steps."""
    return {"simulating people": _people(max(sizes)) + 1, "learning and asking": 2 * len(sizes)}


def benchmark_training(
    sizes: Sequence[int], processes: int, on_step: Callable[[str], None]
) -> Iterator[TrainingCost]:
    """Measure the cost of each number of frames; ``on_step`` gets the stage of every step."""
    simulating, asking = training_steps(sizes)
    with tempfile.TemporaryDirectory(prefix="inhand-bench-") as name:
        folder = Path(name)
        people = [*range(_people(max(sizes))), DEFAULT.stranger]
        in_processes(partial(_simulate, folder), people, processes, lambda _: on_step(simulating))
        for size in sizes:
            learned = _in_fresh_process(_learn, folder, -(-size // DEFAULT.frames))
            on_step(asking)
            asked = _in_fresh_process(_ask, folder)
            on_step(asking)
            yield TrainingCost(learned, asked)


def _people(size: int) -> int:
    return -(-size // (DEFAULT.frames * DEFAULT.performances))


def _simulate(folder: Path, participant: int) -> None:
    """Save what a body tracker saw of a participant, and where the mug was."""
    takes = [
        simulate(INTERACTION, participant, DEFAULT.seed, DEFAULT.frames, performance=performance)
        for performance in range(DEFAULT.performances)
    ]
    joints = np.array([take.joints_in_camera for take in takes])
    joints[np.array([take.joint_states for take in takes]) == 0] = np.nan
    np.savez(
        folder / f"{participant}.npz",
        joints=joints,
        translations=np.array([take.translations for take in takes]),
        rotations=np.array([take.rotations for take in takes]),
        left_handed=takes[0].person.handedness == "left",
    )


def _sequences(folder: Path, participant: int) -> Iterator[LabelledSequence]:
    with np.load(folder / f"{participant}.npz") as saved:
        for joints, translations, rotations in zip(
            saved["joints"], saved["translations"], saved["rotations"], strict=True
        ):
            yield LabelledSequence(
                f"p{participant}", bool(saved["left_handed"]), joints, translations, rotations
            )


def _learn(folder: Path, recordings: int) -> Learning:
    people = range(-(-recordings // DEFAULT.performances))
    sequences = [one for person in people for one in _sequences(folder, person)][:recordings]
    shape = shape_of(simulate(INTERACTION, 0, DEFAULT.seed, 1).object_model)
    began, cpu_began = time.perf_counter(), time.process_time()
    mapping = learn(sequences, shape.mirror_normal)
    training_s, training_cpu_s = time.perf_counter() - began, time.process_time() - cpu_began
    peak_kilobytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    model = Model(INTERACTION, shape, mapping, find_viewpoints(shape))
    began = time.perf_counter()
    save_model(model, folder / MODEL)
    save_s = time.perf_counter() - began
    return Learning(
        frames=len(mapping.body_poses),
        recordings=recordings,
        training_s=training_s,
        training_cpu_s=training_cpu_s,
        peak_memory_mb=peak_kilobytes / 1000.0,
        model_mb=(folder / MODEL).stat().st_size / 1e6,
        save_s=save_s,
    )


def _ask(folder: Path) -> Asking:
    began = time.perf_counter()
    mapping = load_model(folder / MODEL).mapping
    loaded = time.perf_counter()
    index = BodyPoseIndex(mapping)
    indexed = time.perf_counter()
    poses = _body_poses(next(_sequences(folder, DEFAULT.stranger)))
    nearest, nearest_ms = _timed(index.nearest, poses)
    _, cluster_ms = _timed(index.cluster, [frame for frame, _ in nearest])
    some = slice(None, None, max(1, len(poses) // DEFAULT.linear_searches))
    linear, linear_ms = _timed(
        lambda pose: float(cdist(pose[None], mapping.body_poses).min()), poses[some]
    )
    distances = np.array([distance for _, distance in nearest[some]])
    return Asking(
        load_s=loaded - began,
        index_s=indexed - loaded,
        nearest_ms=nearest_ms,
        cluster_ms=cluster_ms,
        linear_ms=linear_ms.p50,
        found=float((distances <= np.array(linear) * (1.0 + DEFAULT.equal_distance)).mean()),
    )


def _body_poses(sequence: LabelledSequence) -> list[Array]:
    """Return the body poses (60,) of the frames in which the whole body was seen."""
    joints = sequence.joints[np.isfinite(sequence.joints).all(axis=(1, 2))]
    return list(body_pose(joints, pelvis_basis(joints), stature_of(joints)))


def _timed(
    function: Callable[[Asked], Result], inputs: Sequence[Asked]
) -> tuple[list[Result], Percentiles]:
    """Return the results of single calls, and how long they took."""
    results, milliseconds = [], []
    for asked in inputs:
        began = time.perf_counter()
        results.append(function(asked))
        milliseconds.append(1e3 * (time.perf_counter() - began))
    return results, Percentiles(*np.percentile(milliseconds, [50, 99]).tolist())


def _in_fresh_process(function: Callable[..., Result], *arguments: object) -> Result:
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        return pool.submit(function, *arguments).result()
