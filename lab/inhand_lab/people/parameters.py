"""How simulated people differ in manner, how far their joints go, and what is easy for an arm."""

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
    follow: float = float(np.radians(30.0))
    """Turn of a varied person's collar bone after a hand that is out of reach or too near, at the
    most; it can be raised by 35 to 45 degrees and protracted by 15 to 30 (the same source)."""


@dataclass(frozen=True)
class ArmComfort:
    """What an arm does with ease: squared ratios to these are what a position costs.

    How they were chosen is not recorded. `inhand simulate --sheet FILE` shows what they make, and
    tests/lab/world/test_world_physics.py holds that arms keep out of the body.
    """

    swivel: float = 0.35
    """Deviation of the elbow's swivel from the person's habit, radians."""
    bend: float = 0.9
    """Bend of the wrist, radians."""
    strained: float = np.inf
    """Bend of the wrist beyond its limit, radians: an elbow gives way before the hand lets go."""
    twist: float = 1.2
    """Twist of the wrist, radians."""
    pressed: float = 0.03
    """Depth to which an elbow presses into the side of the chest, metres."""
    squeeze: float = 0.015
    """Depth to which an arm is pressed into ribs or belly, as a share of their radius."""
    extension: float = np.inf
    """Angle between the bones of an arm beyond which the shoulder goes after the hand, radians: an
    arm that is not quite straight can carry its elbow clear of the trunk."""
    forearm: tuple[tuple[float, float], ...] = ()
    """Places along a forearm that keep clear of ribs and belly too, and its radii there in
    statures."""
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


Spread = tuple[float, float]
"""Mean and deviation of a normal distribution, which is cut at two deviations."""


@dataclass(frozen=True)
class MannerSpread:
    """How people differ in manner: the spreads of Manner's fields, in its units.

    How they were chosen is not recorded; `inhand simulate --realism` compares the movement that
    comes of them with recorded people's.
    """

    tempo: Spread = (0.0, 0.13)
    """Spread of the tempo's logarithm."""
    amplitude: Spread = (0.0, 0.12)
    """Spread of the amplitude's logarithm."""
    stoop: Spread = (0.04, 0.03)
    """Spread of the lean of the trunk, radians."""
    head_pitch: Spread = (-0.05, 0.06)
    """Spread of the pitch of the head, radians."""
    elbow_flare: Spread = (0.45, 0.15)
    """Spread of the elbow's preferred swivel, radians."""
    sway: Spread = (0.010, 0.003)
    """Spread of the deviation of postural sway, metres."""
    restlessness: Spread = (0.0, 0.25)
    """Spread of the restlessness's logarithm."""
    grip_slide: Spread = (0.0, 0.45)
    """Spread of where along a handle the hand takes hold."""
    grip_turn: Spread = (0.0, 0.25)
    """Spread of the turn of an object about its handle, radians."""
    grip_tilt: Spread = (0.12, 0.07)
    """Spread of the angle of a handle across the palm, radians."""


@dataclass(frozen=True)
class CarriageSpread:
    """How varied people differ in carriage: the spreads of Carriage's fields, in its units."""

    head_aside: Spread = (0.0, 0.04)
    """Spread of the tilt of the head to the right, radians (assumed)."""
    head_forward: Spread = (0.0, 0.07)
    """Spread of how far the neck leans forward beyond the usual, radians; the angle from the neck's
    root to the ear differs by about five degrees between adults (Raine and Twomey, *Head and
    shoulder posture variations*, 1997)."""
    shoulders_up: Spread = (0.0, 0.007)
    """Spread of the shoulders' height, in statures: a slope of shoulders that differs by four
    degrees, as in ANSUR II's, lifts them by so much."""
    shoulders_forward: Spread = (0.0, 0.006)
    """Spread of how far round the shoulders are carried forward, in statures (assumed)."""
    stance_width: Spread = (0.0, 0.24)
    """Spread of the logarithm of the feet's distance, over that of the task; heels are 0.17 m apart
    with a deviation of 0.04 m in quiet stance (McIlroy and Maki, *Preferred placement of the feet
    during quiet stance*, 1997)."""
    toes_out: Spread = (0.15, 0.08)
    """Spread of the turn of each foot outwards, radians (the same source)."""
    foot_ahead: Spread = (0.0, 0.02)
    """Spread of how far the right foot is ahead of the left, in statures (assumed)."""
    weight_aside: Spread = (0.0, 0.012)
    """Spread of how far the weight is on the right foot, in statures (assumed)."""


USUAL_MANNERS = MannerSpread()
"""How usual people differ in manner."""
VARIED_MANNERS = MannerSpread(
    tempo=(0.0, 0.14),
    head_pitch=(-0.05, 0.08),
    elbow_flare=(0.45, 0.25),
    restlessness=(0.0, 0.35),
    amplitude=(0.0, 0.16),
    grip_turn=(0.0, 0.35),
    grip_tilt=(0.12, 0.10),
)
"""How varied people do. More lean and turn of trunks would be worse: fusion taught by six people
erred more on real bodies with it (docs/simulator.md)."""
DEFAULT_CARRIAGES = CarriageSpread()
"""How varied people differ in carriage; usual people do not."""
DEFAULT_LIMITS = JointLimits()
"""Limits of every simulated person."""
USUAL_COMFORT = ArmComfort()
"""Comfort of usual people."""
VARIED_COMFORT = ArmComfort(
    strained=0.25,
    extension=float(np.radians(160.0)),
    forearm=((0.3, 0.0216), (0.55, 0.0196), (0.8, 0.0176)),
)
"""Comfort of varied people, whose arms hang in more ways: some of these have no swivel that frees
them from ribs and belly unless the shoulder follows the hand."""
