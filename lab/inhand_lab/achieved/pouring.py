"""True pours."""

from __future__ import annotations

import numpy as np

from inhand_lab.achieved.liquid import emptied_ml
from inhand_lab.achieved.spans import bounds, spans, world_from_object
from inhand_lab.achieved.true_achievement import TrueAchievement
from inhand_lab.world.simulation import Simulation

TILTED = 0.40
"""Tilt towards the spout beyond which somebody pours, radians."""
POUR_ML, POUR_DEVIATION_ML = 20.0, 10.0
"""Volume of cream for a cup: a serving is a tablespoon, 15 ml (21 CFR 101.12), and people pour
more."""


def true_pours(simulation: Simulation) -> list[TrueAchievement]:
    """The times when the jug is tilted, with the deepest tilt; ``volume_ml`` as in liquid."""
    axis = world_from_object(simulation).rotation[:, :, 2]
    tilt = np.arccos(np.clip(axis[:, 2], -1.0, 1.0))
    pours = list(spans(simulation, tilt > TILTED, 0.1))
    volumes = emptied_ml(simulation, pours, POUR_ML, POUR_DEVIATION_ML)
    achieved = []
    for pour, volume in zip(pours, volumes, strict=True):
        start, end = bounds(simulation, pour)
        deepest = float(np.degrees(tilt[pour].max()))
        amounts = {"angle_deg": deepest, "duration_s": end - start, "volume_ml": volume}
        achieved.append(TrueAchievement("pour", start, end, amounts))
    return achieved
