"""True sips."""

from __future__ import annotations

import numpy as np

from inhand_lab.achieved.liquid import emptied_ml
from inhand_lab.achieved.spans import (
    bounds,
    spans,
    true_mouth,
    world_from_object,
)
from inhand_lab.achieved.true_achievement import TrueAchievement
from inhand_lab.objects.mug import MUG_HEIGHT, MUG_RADIUS
from inhand_lab.world.simulation import Simulation

AT_LIPS = 0.03
"""Distance of the rim's lowest point from the lips at which the mug is there, metres."""
TILTED = 0.25
"""Tilt beyond which somebody drinks, radians: a little more than that of a mug that is raised."""
SIP_ML, SIP_DEVIATION_ML = 20.0, 8.0
"""Volume of a sip: 25 ml in men and 20 ml in women (Lawless et al., 2003, doi
10.1007/s00455-002-0105-0), 16 ml where nobody was told (Bennett et al., 2009, doi
10.1007/s00455-008-9183-y)."""


def true_sips(simulation: Simulation) -> list[TrueAchievement]:
    """The times when the mug's rim is at the lips and it is tilted; ``volume_ml`` as in liquid."""
    mug = world_from_object(simulation)
    axis = mug.rotation[:, :, 2]
    tilt = np.arccos(np.clip(axis[:, 2], -1.0, 1.0))
    low = axis[:, 2:] * axis - [0.0, 0.0, 1.0]
    low /= np.maximum(np.linalg.norm(low, axis=1, keepdims=True), 1e-9)
    lip = mug.translation + 0.5 * MUG_HEIGHT * axis + MUG_RADIUS * low
    near = np.linalg.norm(lip - true_mouth(simulation), axis=1) < AT_LIPS
    sips = list(spans(simulation, near & (tilt > TILTED), 0.2))
    volumes = emptied_ml(simulation, sips, SIP_ML, SIP_DEVIATION_ML)
    return [
        TrueAchievement("sip", *bounds(simulation, sip), {"volume_ml": volume})
        for sip, volume in zip(sips, volumes, strict=True)
    ]
