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
}
"""Cameras that film people who use an object, by the views that a dataset has of them: from before,
as one sets a camera up to see what is done, or from anywhere round, from a low shelf to the top of
one, as far as a Kinect measures well (0.8 to 4 m)."""
USUAL_VIEWS = "before"
"""Views of a dataset that names none."""
IDLE_CAMERA_PLACING = CameraPlacing(distance=(2.9, 3.6), aside=0.5)
"""Cameras before people who use nothing; they look at the world's middle."""
DEFAULT_WALK = WalkParameters()
"""How all walk who walk."""
DEFAULT_IDLE_HANDS = IdleHandParameters()
"""What all idle hands do."""
