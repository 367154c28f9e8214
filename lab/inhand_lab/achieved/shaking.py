"""True shakes of a bottle: each bout, with the strokes that it had."""

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import find_peaks

from inhand_lab.achieved.true_achievement import TrueAchievement
from inhand_lab.world.simulation import Simulation

LEAST_STROKE_M = 0.016
"""Way of the bottle along its axis, in a stroke, at least."""
FINER = 8
"""Times between two frames at which the way between them is looked at."""


def true_shaking(simulation: Simulation) -> list[TrueAchievement]:
    """One shake for each stage of shaking that ends before the recording does, from the beginning
    of its first stroke to the end of its last.

    Strokes are the ways of the bottle's middle along its axis towards its mouth, from one turn to
    the next.
    """
    pose = simulation.camera_from_object
    times = np.arange(simulation.frames) / simulation.frame_rate
    fine = np.linspace(times[0], times[-1], FINER * (len(times) - 1) + 1)
    speeds = CubicSpline(times, pose.translation)(fine, 1)
    axes = CubicSpline(times, pose.rotation[:, :, 2])(fine)
    gone = np.cumsum(np.sum(speeds * axes, axis=1)) * (fine[1] - fine[0])
    found = []
    for stage in simulation.stages:
        if stage.name != "shake" or stage.end > times[-1]:
            continue
        inside = (fine >= stage.start - 0.1) & (fine <= stage.end + 0.1)
        way = gone[inside]
        peaks, valleys = find_peaks(way)[0], find_peaks(-way)[0]
        bounds = [
            (int(before[-1]) if len(before := valleys[valleys < peak]) else 0, int(peak))
            for peak in peaks
        ]
        strokes = [(low, high) for low, high in bounds if way[high] - way[low] >= LEAST_STROKE_M]
        if not strokes:
            continue
        start, end = (float(fine[inside][at]) for at in (strokes[0][0], strokes[-1][1]))
        amounts = {"stroke_count": float(len(strokes)), "duration_s": end - start}
        found.append(TrueAchievement("shake", start, end, amounts))
    return found
