"""Compares what a rig's cameras track together with what each tracks alone, on simulated people.

Nobody is learned from who is tracked: one person of each seed is, and others of that seed, each
filmed by one camera, are learned from. One camera fails in the middle of each recording, now this
and now that one.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.rig.placing import PlaceDeviation

from inhand_lab.benchmarks.parameters import DEFAULT_RIGS, RigCheckParameters
from inhand_lab.benchmarks.rig_models import learn_model
from inhand_lab.benchmarks.rig_tracking import NOT_OFF, RigErrors, track_rig
from inhand_lab.workers import in_processes
from inhand_lab.world.rigs import simulate_rig
from inhand_lab.world.simulation import simulate


@dataclass(frozen=True)
class RigRun:
    """What is tracked: an interaction of a seed's first person, before so many cameras; who is
    ``roaming`` walks about and turns. Cameras are ``placed_off`` from where they are by about as
    much as their calibration says."""

    interaction: str
    seed: int
    cameras: int
    roaming: bool
    placed_off: PlaceDeviation = NOT_OFF
    parameters: RigCheckParameters = DEFAULT_RIGS


@dataclass(frozen=True)
class RigCheck:
    """Errors of one recording, in metres: by each camera alone, by all, and by how much poses leap
    when one of them fails. ``frames`` is their number, and ``region_share`` that of all cameras'
    poses whose 90 % region holds the truth; costs are medians, in milliseconds of processor time
    for a frame."""

    interaction: str
    seed: int
    single_m: dict[str, float]
    fused_m: float
    frames: int
    without_pose: int
    killed: str
    killed_m: float
    killed_without_pose: int
    jump_m: float
    usual_jump_m: float
    region_share: float
    single_ms: float
    fused_ms: float

    @property
    def best_m(self) -> float:
        """Error of the camera that is best alone."""
        return min(self.single_m.values())

    @property
    def mean_m(self) -> float:
        """Mean error of the cameras alone."""
        return float(np.mean(list(self.single_m.values())))


def check_rigs(
    runs: Sequence[RigRun], processes: int, on_done: Callable[[], None] = lambda: None
) -> list[RigCheck]:
    """Track all; ``on_done`` is called after each."""
    return in_processes(check_rig, runs, processes, lambda _: on_done())


def check_rig(run: RigRun) -> RigCheck:
    """Simulate, learn and track one recording; raises ValueError for what cannot be simulated."""
    parameters = run.parameters
    rig = simulate_rig(
        run.interaction, 0, run.seed, parameters.frames, run.cameras, roaming=run.roaming
    )
    learned = [
        simulate(run.interaction, person, run.seed, parameters.learned_frames)
        for person in range(1, parameters.people + 1)
    ]
    killed = run.seed % run.cameras
    model = learn_model(learned, parameters.looks)
    errors = track_rig(rig, model, killed=killed, placed_off=run.placed_off)
    return _check(run, rig.names[killed], errors)


def _check(run: RigRun, killed_name: str, errors: RigErrors) -> RigCheck:
    fused, killed = errors.fused, errors.killed
    return RigCheck(
        run.interaction,
        run.seed,
        {name: one.mean_m for name, one in errors.single.items()},
        fused.mean_m,
        len(fused.vertex_m),
        fused.without_pose,
        killed_name,
        fused.mean_m if killed is None else killed.mean_m,
        0 if killed is None else killed.without_pose,
        errors.jump_m,
        errors.usual_jump_m,
        fused.region_share,
        float(np.median([one.frame_ms for one in errors.single.values()])),
        fused.frame_ms,
    )
