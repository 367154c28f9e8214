"""How far a simulated person's joints go, and what is comfortable for an arm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class JointLimits:
    """Angles that joints keep within, radians."""

    elbow_extension: float = float(np.radians(172.0))
    """Angle between the bones of an arm that is stretched."""
    knee_extension: float = float(np.radians(178.0))
    """Angle between the bones of a leg that is stretched."""
    flexion: float = float(np.radians(30.0))
    """Angle between the bones of an arm or a leg that is bent as far as it goes."""
    wrist_bend: float = float(np.radians(75.0))
    """Bend of a wrist, out of the forearm's direction, at the most."""
    protraction: float = float(np.radians(25.0))
    """Turn of a collar bone forward for an arm that reaches straight across the chest; it can by 15
    to 30 degrees (Neumann, *Kinesiology of the Musculoskeletal System*)."""


@dataclass(frozen=True)
class ArmComfort:
    """What an arm does with ease: squared ratios to these are what a position costs.

    They were chosen by eye, so that arms keep out of the body and people look natural (`inhand
    simulate --sheet FILE`); tests hold the first.
    """

    swivel: float = 0.35
    """Deviation of the elbow's swivel from the person's habit, radians."""
    bend: float = 0.9
    """Bend of the wrist, radians."""
    twist: float = 1.2
    """Twist of the wrist, radians."""
    pressed: float = 0.03
    """Depth to which an elbow presses into the side of the chest, metres."""
    squeeze: float = 0.015
    """Depth to which an upper arm is pressed into ribs or belly, as a share of their radius."""
    elbow_gap: float = 0.03
    """Distance of the elbow from the shoulder's breadth within which the chest is, metres."""
    chest_depth: float = 0.05
    """Distance ahead of the chest's middle from which it grows narrower, metres."""
    stout_elbows: float = 0.30
    """Distance by which stout people carry their elbows further from the trunk, in statures a share
    of girth."""
    lowest_swivel: float = -0.4
    """Least of the swivels that are compared, radians from hanging straight down."""
    highest_swivel: float = 1.7
    """Largest of the swivels that are compared, radians."""
    swivels: int = 22
    """Number of swivels that are compared."""


DEFAULT_LIMITS = JointLimits()
"""Limits of every simulated person."""
DEFAULT_COMFORT = ArmComfort()
"""Comfort of every simulated person."""
