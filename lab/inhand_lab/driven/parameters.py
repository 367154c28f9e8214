"""How a recorded body is cleaned of noise, and how it holds a simulated object."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class DenoisingParameters:
    """How the body behind a tracker's joints is found.

    How they were chosen is not recorded; docs/simulator.md says how far UTD-MHAD's joints then are
    from the body that is found.
    """

    cut_off: float = 5.0
    """Frequency at which half of a movement is kept, Hz: arms move at will below it."""
    path_deviation: float = 0.03
    """Distance from its path at which a joint counts half, metres."""
    bone_deviation: float = 0.25
    """Change of a bone's length, as a share of it, at which the joint at its end counts half."""
    reweightings: int = 6
    """Number of times that a path is smoothed with weights by the distances from it."""
    least_weight: float = 1e-6
    """Weight that keeps the smoother's equations regular where hardly anything was seen."""
    relaxations: int = 30
    """Number of times that joints are moved to give bones their lengths."""


@dataclass(frozen=True)
class SeenFrameParameters:
    """How frames of the body's parts are read from joints."""

    straight: float = 0.15
    """Sine of an elbow's bend that shows as much of the arm's plane as is assumed of it anyway."""
    hand_share: float = 0.5
    """Weight of the way from wrist to hand beside the forearm's: the hand is seen the worst."""
    roll_cut_off: float = 2.5
    """Frequency at which half of a thumb's turn about its fingers is kept, Hz."""


@dataclass(frozen=True)
class HoldParameters:
    """How an object is held by a recorded body, and what its skeleton does not show.

    The twist and the look are assumed: no recording shows them.
    """

    lever: float = 0.10
    """Distance between hands at which their places count as much as one hand's turn, metres."""
    unsure: float = 0.20
    """Distance of the palms below which the way between them is mostly noise, metres."""
    unseen_twist: float = 0.25
    """Deviation of the forearm's twist that no joint shows, radians."""
    twist_period: float = 2.0
    """Time in which the twist drifts, seconds."""
    unseen_look: float = 0.20
    """Deviation of the head's turn that no joint shows, radians."""
    look_period: float = 3.0
    """Time in which the head's turn drifts, seconds."""


DEFAULT_DENOISING = DenoisingParameters()
"""How every recorded body is cleaned."""
DEFAULT_SEEN_FRAMES = SeenFrameParameters()
"""How frames are read from every recorded body."""
DEFAULT_HOLD = HoldParameters()
"""How every recorded body holds objects."""
