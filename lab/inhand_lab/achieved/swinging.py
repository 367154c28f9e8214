"""True strokes with a racket and swings of a golf club, with speed and plane of the head."""

import numpy as np
from inhand_tracker.geometry.arrays import Array
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation, RotationSpline

from inhand_lab.achieved.true_achievement import TrueAchievement
from inhand_lab.objects.golf_club import SOLE
from inhand_lab.objects.racket import HEAD_CENTRE
from inhand_lab.world.simulation import Simulation

RACKET_HEAD = np.array([0.0, 0.0, HEAD_CENTRE])
CLUB_HEAD = np.array([0.0, 0.036, SOLE + 0.028])
"""The middles of the two heads."""
FINER = 16
"""Times between two frames at which the way between them is looked at."""
FAST = 0.45
"""Share of the highest speed above which the head's way is in the plane of the stroke."""


def true_tennis(simulation: Simulation) -> list[TrueAchievement]:
    """One stroke for each stage of that name that ends before the recording does."""
    return _swings(simulation, "stroke", RACKET_HEAD)


def true_golf(simulation: Simulation) -> list[TrueAchievement]:
    """One swing for each stage of that name that ends before the recording does."""
    return _swings(simulation, "swing", CLUB_HEAD)


def _swings(simulation: Simulation, name: str, head: Array) -> list[TrueAchievement]:
    pose = simulation.camera_from_world.inverse() @ simulation.camera_from_object
    times = np.arange(simulation.frames) / simulation.frame_rate
    fine = np.linspace(times[0], times[-1], FINER * (len(times) - 1) + 1)
    turned = RotationSpline(times, Rotation.from_matrix(pose.rotation))(fine).apply(head)
    way = CubicSpline(times, pose.translation)(fine) + turned
    speeds = np.linalg.norm(np.gradient(way, fine, axis=0), axis=1)
    found = []
    for stage in simulation.stages:
        if stage.name != name or stage.end > times[-1]:
            continue
        inside = (fine >= stage.start) & (fine <= stage.end)
        highest = float(speeds[inside].max())
        # The fast part about the peak, without what is fast before or after it.
        peak = int(np.flatnonzero(inside)[np.argmax(speeds[inside])])
        slow = np.flatnonzero(speeds < FAST * highest)
        first, last = slow[slow < peak][-1], slow[slow > peak][0]
        part = way[first:last]
        normal = np.linalg.svd(part - part.mean(axis=0), full_matrices=False)[2][2]
        amounts = {
            "speed_m_s": highest,
            "angle_deg": float(np.degrees(np.arccos(np.clip(abs(normal[2]), 0.0, 1.0)))),
        }
        found.append(TrueAchievement(name, float(fine[first]), float(fine[last]), amounts))
    return found
