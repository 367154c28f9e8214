"""Measures what whole frames cost on one core: by stages, and by objects and people."""

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from inhand_lab.benchmarks.frame_stages import StageCosts, measure_stages
from inhand_lab.benchmarks.learned_objects import learn_objects, preparation_steps
from inhand_lab.benchmarks.parameters import DEFAULT_FRAME_COST, FrameCostParameters
from inhand_lab.benchmarks.watching_cost import WatchingCost, measure_watching
from inhand_lab.workers import on_one_core

PREPARING, MEASURING = "simulating and learning", "measuring frames"


@dataclass(frozen=True)
class FrameCosts:
    """Costs of a frame of one object with an image and without, and of frames in which several
    objects of several people are watched at ``frame_rate`` frames a second."""

    seen: StageCosts
    unseen: StageCosts
    watching: tuple[WatchingCost, ...]
    frame_rate: float


def frame_steps(parameters: FrameCostParameters = DEFAULT_FRAME_COST) -> dict[str, int]:
    """Return the stages of the measurement, each with the number of its steps."""
    counts = len(parameters.people_counts) * len(parameters.object_counts)
    preparing = preparation_steps(parameters.interactions, parameters.people)
    return {PREPARING: preparing, MEASURING: 2 + counts}


def measure_frames(
    on_step: Callable[[str], None], parameters: FrameCostParameters = DEFAULT_FRAME_COST
) -> FrameCosts:
    """Measure all; ``on_step`` gets the stage of every step."""
    with tempfile.TemporaryDirectory(prefix="inhand-bench-") as name:
        learned = learn_objects(
            Path(name), parameters.interactions, parameters.people, lambda: on_step(PREPARING)
        )
        with on_one_core():
            seen = measure_stages(learned, parameters.first_frames, images=True)
            on_step(MEASURING)
            unseen = measure_stages(learned, parameters.first_frames, images=False)
            on_step(MEASURING)
            watching = []
            for cost in measure_watching(learned, parameters):
                watching.append(cost)
                on_step(MEASURING)
    return FrameCosts(seen, unseen, tuple(watching), parameters.frame_rate)
