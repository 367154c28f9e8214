"""True times of putting on a shoe and taking it off."""

from __future__ import annotations

import numpy as np
from inhand_schemas.joints import Joint

from inhand_lab.achieved.spans import bounds, spans, world_from_object
from inhand_lab.achieved.true_achievement import TrueAchievement
from inhand_lab.world.simulation import Simulation

ON_FOOT = 0.04
"""Distance of the shoe's place for the ankle from the ankle at which it is on, metres."""


def true_shoes(simulation: Simulation) -> list[TrueAchievement]:
    """When the shoe came on the foot, and when it left it."""
    shoe = world_from_object(simulation)
    ankle = np.array([0.0, 0.0, simulation.person.proportions.ankle])
    joints = simulation.camera_from_world.inverse().apply(simulation.true_joints_in_camera)
    away = np.min(
        [
            np.linalg.norm(shoe.apply(ankle) - joints[:, joint], axis=1)
            for joint in (Joint.ANKLE_LEFT, Joint.ANKLE_RIGHT)
        ],
        axis=0,
    )
    found = []
    for span in spans(simulation, away < ON_FOOT, 0.2):
        start, end = bounds(simulation, span)
        found += [TrueAchievement("shoe_on", start, start), TrueAchievement("shoe_off", end, end)]
    return found
