"""True strikes: when the hammer's face was on the nail at the end of a stroke."""

import numpy as np

from inhand_lab.achieved.true_achievement import TrueAchievement
from inhand_lab.motions.hammer_nail import BACKSWING, FACE, STROKES
from inhand_lab.world.simulation import Simulation

FURTHEST = 0.3
"""Share of a stroke's time by which its lowest point may be off its end."""


def true_hammering(simulation: Simulation) -> list[TrueAchievement]:
    """Each strike, light or hard, from about the top of the backswing to the moment at which the
    face is lowest about the stroke's end.

    A stage of taps or of strikes has as many as the script says, in equal times.
    """
    world_from_camera = simulation.camera_from_world.inverse()
    face = (world_from_camera @ simulation.camera_from_object).apply(FACE)
    times = np.arange(simulation.frames) / simulation.frame_rate
    speed = np.linalg.norm(np.gradient(face, axis=0), axis=1) * simulation.frame_rate
    strikes = []
    for stage in simulation.stages:
        count = STROKES.get(stage.name, 0)
        for number in range(count):
            beat = stage.seconds / count
            end = stage.start + (number + 1) * beat
            near = np.flatnonzero(np.abs(times - end) <= FURTHEST * beat)
            if end >= times[-1] or len(near) == 0:
                continue
            at = float(times[near[np.argmin(face[near, 2])]])
            fastest = float(speed[(times > end - 0.5 * beat) & (times <= end)].max(initial=0.0))
            amounts = {"speed_m_s": fastest, "rate_per_min": 60.0 / beat}
            fall = at - (1.0 - BACKSWING) * beat
            strikes.append(TrueAchievement("strike", fall, at, amounts))
    return strikes
