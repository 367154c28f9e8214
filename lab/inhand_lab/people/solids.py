"""The rounded solids of a trunk and a head: what a body looks like, and what its arms go round."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.people.person import SimulatedPerson

CHEST_BREADTH, CHEST_CONSTANCY = 0.76, 0.5
"""Breadth of the ribs over that of the shoulders, and how it goes with girth: in ANSUR II chests
are 0.29 m broad in men of 1.76 m, and differ by 6 % where waists differ by 10 %."""

BROADEST_CHEST = 0.77
"""The same in the stoutest: an arm that hangs lies beside the ribs, whatever the girth."""


def head_radii(person: SimulatedPerson) -> Array:
    """Half axes (3,) of the head's ellipsoid about its middle, metres."""
    body = person.proportions
    return np.array([body.head_half_width, body.head_half_depth, body.head_half_height])


def rib_cage(person: SimulatedPerson) -> tuple[Array, Array]:
    """Centre and half axes (3,) of an ellipsoid in the chest's frame, metres."""
    size, trunk = person.height * person.girth, person.proportions.chest
    share = min(CHEST_BREADTH * person.girth**CHEST_CONSTANCY, BROADEST_CHEST)
    radii = np.array([share * person.proportions.shoulder_half_width, 0.066 * size, 0.66 * trunk])
    return np.array([0.0, 0.004, -0.45 * trunk]), radii


def belly(person: SimulatedPerson) -> tuple[Array, Array]:
    """Centre and half axes (3,) of an ellipsoid in the chest's frame, metres."""
    size, trunk = person.height * person.girth, person.proportions.chest
    radii = np.array([0.088 * size, 0.066 * size, 0.50 * trunk])
    return np.array([0.0, 0.008, -0.90 * trunk]), radii


def pelvis(person: SimulatedPerson) -> tuple[Array, Array]:
    """Centre and half axes (3,) of an ellipsoid in the pelvis's frame, metres."""
    size, drop = person.height * person.girth, person.proportions.hip_drop
    return np.array([0.0, 0.0, -0.6 * drop]), np.array([0.093, 0.068, 0.075]) * size
