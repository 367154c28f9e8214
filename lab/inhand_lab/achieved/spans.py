"""When something is so, and where things and bodies are in the world."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from inhand_tracker.geometry.arrays import Array, Flags

from inhand_lab.geometry.transforms import Transform
from inhand_lab.world.simulation import Simulation


def frame_times(simulation: Simulation) -> Array:
    """Times (T,) of a simulation's frames, seconds."""
    return np.arange(simulation.frames) / simulation.frame_rate


def world_from_object(simulation: Simulation) -> Transform:
    """Where the thing truly is, z up (T)."""
    return simulation.camera_from_world.inverse() @ simulation.camera_from_object


def world_from_head(simulation: Simulation) -> Transform:
    """The true head (T): x to its right, y ahead, z up; the origin is its middle."""
    return simulation.camera_from_world.inverse() @ simulation.body_in_camera.from_head


def true_mouth(simulation: Simulation) -> Array:
    """The lips (T, 3) in the world."""
    body = simulation.person.proportions
    lips = np.array([0.0, 0.93 * body.head_half_depth, -0.54 * body.head_half_height])
    return world_from_head(simulation).apply(lips)


def spans(simulation: Simulation, so: Flags, longest_gap_s: float = 0.0) -> Iterator[slice]:
    """The runs of frames where ``so`` (T,) holds; shorter gaps than ``longest_gap_s`` are filled.

    What the first or the last frame cuts is left out.
    """
    frames = np.flatnonzero(so)
    if not len(frames):
        return
    gap = 1.0 + longest_gap_s * simulation.frame_rate
    cuts = np.flatnonzero(np.diff(frames) > gap)
    firsts = frames[np.concatenate([[0], cuts + 1])]
    lasts = frames[np.concatenate([cuts, [len(frames) - 1]])]
    for first, last in zip(firsts, lasts, strict=True):
        if first > 0 and last < simulation.frames - 1:
            yield slice(int(first), int(last) + 1)


def bounds(simulation: Simulation, frames: slice) -> tuple[float, float]:
    """Start and end of a run of frames, seconds: it holds from halfway to its first one."""
    rate = simulation.frame_rate
    return (frames.start - 0.5) / rate, (frames.stop - 0.5) / rate
