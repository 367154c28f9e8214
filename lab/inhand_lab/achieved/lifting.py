"""True repetitions with a bar: up to the chest and down again."""

import numpy as np

from inhand_lab.achieved.true_achievement import TrueAchievement
from inhand_lab.objects.barbell import BAR_HALF_LENGTH
from inhand_lab.world.simulation import Simulation

ENDS = np.array([[BAR_HALF_LENGTH, 0.0, 0.0], [-BAR_HALF_LENGTH, 0.0, 0.0]])


def true_lifting(simulation: Simulation) -> list[TrueAchievement]:
    """One repetition for each curl that is lowered again before the recording ends.

    The bar's x axis points to the person's right, or, of the mirror image of a person, left.
    """
    pose = simulation.camera_from_world.inverse() @ simulation.camera_from_object
    height = pose.translation[:, 2]
    times = np.arange(simulation.frames) / simulation.frame_rate
    right, left = (pose.apply(end)[:, 2] for end in ENDS)
    across = simulation.camera_from_world.rotation.T @ (
        simulation.true_joints_in_camera[:, 8] - simulation.true_joints_in_camera[:, 4]
    ).mean(axis=0)
    side = np.sign(np.mean(pose.rotation[:, :, 0] @ across))
    found = []
    for curl in (stage for stage in simulation.stages if stage.name == "curl"):
        lower = next(
            stage
            for stage in simulation.stages
            if stage.name == "lower" and stage.repetition == curl.repetition
        )
        if lower.end > times[-1]:
            continue
        inside = (times >= curl.start) & (times <= lower.end)
        at = height[inside]
        tilt = side * np.arcsin((right - left)[inside] / (2.0 * BAR_HALF_LENGTH))
        amounts = {
            "range_m": float(min(at.max() - at[0], at.max() - at[-1])),
            "up_s": curl.seconds,
            "down_s": lower.seconds,
            "duration_s": lower.end - curl.start,
            "tilt_deg": float(np.degrees(tilt.mean())),
            "difference_m": float(side * (right - left)[inside].mean()),
        }
        found.append(TrueAchievement("repetition", curl.start, lower.end, amounts))
    return found
