"""Where cameras stand in the simulated world, how people walk, and what idle hands do.

How the sizes were chosen is not recorded; `inhand simulate --sheet FILE` shows what they make.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

Range = tuple[float, float]
"""Least and largest value of a uniform distribution."""


@dataclass(frozen=True)
class CameraPlacing:
    """Where a camera stands that films people."""

    height: Range = (1.0, 1.4)
    """Height above the floor, metres."""
    distance: Range = (2.2, 3.0)
    """Distance from the person, metres; more where the person would not fit."""
    aside: float = float(np.radians(30.0))
    """Angle by which it is aside of what the person faces, at the most, radians."""
    tries: int = 1
    """Number of places, at most, of which the first is taken from where no furniture hides the
    person."""
    headroom: float = 0.60
    """Height that is in the image beside the person's, metres."""
    aim: float = 0.43
    """Height that the camera looks at, as a share of stature."""


@dataclass(frozen=True)
class RigParameters:
    """How the cameras of a rig differ that nobody triggers together."""

    clock_offset_s: float = 0.03
    """Time by which a clock is off from the first camera's, seconds, at the most: what hosts on
    one network whose clocks are set by it are apart."""
    clock_drift_ppm: float = 30.0
    """Microseconds by which a clock is off more every second, at the most: a quartz's tolerance."""
    dropped_share: Range = (0.0, 0.02)
    """Share of a camera's frames that are lost."""
    tries: int = 40
    """Number of places, usual and other ones each, of which a camera takes the first that is before
    the walls and from where no furniture hides the person."""


@dataclass(frozen=True)
class RigCamera:
    """A camera of a rig: its name, and where it stands."""

    name: str
    around: Range
    """Angle from the first camera about the person, to the person's left, radians."""
    around_if_hidden: Range
    """That angle where furniture hides the person from everywhere there."""
    height: Range
    """Height above the floor, metres."""


@dataclass(frozen=True)
class WalkParameters:
    """How people walk."""

    cadence: float = 1.75
    """Steps a second."""
    stride: float = 0.62
    """Length of a step, metres for 1.75 m of stature."""
    swing: float = 0.8
    """Time for which a foot is lifted, as a share of the time from step to step."""
    lift: float = 0.10
    """Height to which a foot is lifted, metres."""
    half_track: float = 0.08
    """Distance of a foot from the middle of the way, metres."""
    arm_swing: float = 0.35
    """Angle by which arms swing, radians."""


@dataclass(frozen=True)
class RoamingParameters:
    """How people walk about and turn while they use a thing.

    They walk slowly enough that their hips go down by a centimetre or so, as whoever carries a cup.
    """

    leg_s: float = 2.0
    """Time from one place to the next, seconds, about."""
    walking: float = 0.22
    """Mean speed between two places, at the most, metres a second."""
    turning: float = float(np.radians(50.0))
    """Mean speed of a turn, at the most, radians a second."""
    turned: Range = (0.5 * float(np.pi), float(np.pi))
    """Angle to which somebody turns, now to one side and now to the other, radians; less where time
    is short."""
    radius: float = 1.0
    """Distance from the first place, at the most, metres."""
    clearance: float = 0.9
    """Distance from furniture that is enough, metres."""
    tries: int = 40
    """Number of places that are tried each time."""
    aloof: float = 0.5
    """Share of the first and of the last way, at furniture, on which nobody turns."""
    cadence: float = 2.0
    """Steps a second."""
    swing: float = 0.8
    """Time for which a foot is lifted, as a share of the time from step to step."""
    lift: float = 0.06
    """Height to which a foot is lifted, at the most, metres."""
    pivot: float = 0.1
    """Height to which a foot is lifted for a turn on the spot, metres for each radian."""
    straightest: float = 0.999
    """Straightness of a leg, as a share of its length, beyond which hips go down instead."""
    further: float = 1.0
    """Distance by which the back wall is farther away in a room to walk about in, metres."""


@dataclass(frozen=True)
class HandoverParameters:
    """How two people meet, hand something over and pass each other; times are seconds from the
    beginning, places metres in each one's frame, ahead of where they stand for it and to the right.
    """

    ahead: float = 0.42
    """Distance ahead of each at which the thing changes hands, metres."""
    aside: float = 0.10
    """Distance to the right of each at which it does, metres."""
    height: float = 0.64
    """Height at which it does, as a share of the mean stature."""
    comes_s: Range = (0.2, 4.2)
    """From when to when they walk up to each other."""
    from_m: float = 0.8
    """Distance that each comes, metres."""
    offered_s: Range = (4.0, 5.0)
    """From when to when the giver holds it out."""
    reached_s: Range = (4.4, 5.5)
    """From when to when the taker reaches for it."""
    handed_s: float = 5.9
    """When it changes hands."""
    lingering_s: float = 0.3
    """Time for which both hands stay there then, seconds."""
    way_s: float = 0.9
    """Time in which the giver's arm sinks, and the taker's comes back with it, seconds."""
    passes_s: tuple[float, float, float] = (7.2, 9.0, 14.4)
    """From when, over when, to when they walk past each other."""
    evades_m: tuple[float, float] = (-0.35, 0.10)
    """To where each steps aside first, metres."""
    leaves_m: tuple[float, float] = (-0.35, 1.45)
    """To where each goes, past the other, metres."""
    most_covered: float = 0.6
    """Share of joints that somebody else hides beyond which nobody is followed."""
    forgotten_s: float = 0.5
    """Time after which who comes back is somebody new to a skeleton tracker, seconds."""


@dataclass(frozen=True)
class IdleHandParameters:
    """How long hands gesture, fidget and hang."""

    both_hands: float = 0.4
    """Share of gestures that are of both hands."""
    gesture_s: Range = (1.0, 4.0)
    """Time for which a gesture lasts, seconds."""
    hanging_s: Range = (1.0, 5.0)
    """Time for which hands hang, seconds."""
    way_s: float = 0.7
    """Time that a hand takes to a gesture and back, seconds."""
    fidget_low: tuple[float, float, float] = (-0.30, -0.10, -0.60)
    """Lower corner of where a fidgeting right hand goes, in the chest's frame of a person of
    1.75 m, metres."""
    fidget_high: tuple[float, float, float] = (0.60, 0.55, 0.55)
    """Upper corner of where it goes."""
    fidget_s: Range = (0.0, 1.5)
    """Time for which a fidgeting hand rests, seconds."""
    fidget_way_s: Range = (0.3, 1.2)
    """Time for which a fidgeting hand is on its way, seconds."""
    fidgets: int = 6
    """Number of places that a fidgeting hand goes to before it hangs again, at most."""


CAMERA_PLACINGS = {
    "before": CameraPlacing(),
    "around": CameraPlacing(height=(0.7, 2.0), distance=(2.2, 3.8), aside=float(np.pi), tries=20),
    "far": CameraPlacing(distance=(3.0, 3.6)),
}
"""Cameras that film people who use an object, by the views that a dataset has of them: from before,
as one sets a camera up to see what is done, from anywhere round, from a low shelf to the top of
one, as far as a Kinect measures well (0.8 to 4 m), or from before and far enough for people who
walk about."""
USUAL_VIEWS = "before"
"""Views of a dataset that names none."""
IDLE_CAMERA_PLACING = CameraPlacing(distance=(2.9, 3.6), aside=0.5)
"""Cameras before people who use nothing; they look at the world's middle."""


def _degrees(least: float, largest: float) -> Range:
    return float(np.radians(least)), float(np.radians(largest))


RIG_CAMERAS = (
    RigCamera("front", (0.0, 0.0), (0.0, 0.0), CameraPlacing().height),
    RigCamera("left", _degrees(60.0, 120.0), _degrees(25.0, 150.0), (0.9, 2.0)),
    RigCamera("right", _degrees(-120.0, -60.0), _degrees(-150.0, -25.0), (0.9, 2.0)),
    RigCamera("high", _degrees(-50.0, 50.0), _degrees(-120.0, 120.0), (2.1, 2.5)),
)
"""Cameras of a rig in the order in which it has them; the first stands as one does that is alone,
whatever is said of it here."""
USUAL_RIG = RigParameters()
"""How the cameras of every simulated rig differ."""
DEFAULT_ROAMING = RoamingParameters()
"""How all walk about who do while they use a thing."""
DEFAULT_HANDOVER = HandoverParameters()
"""How all hand things over."""
ROAMING_VIEWS = "far"
"""Views of people who walk about."""
DEFAULT_WALK = WalkParameters()
"""How all walk who walk."""
DEFAULT_IDLE_HANDS = IdleHandParameters()
"""What all idle hands do."""
