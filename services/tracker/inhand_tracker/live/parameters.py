"""Every number by which a live tracker keeps on time."""

from dataclasses import dataclass


@dataclass(frozen=True)
class MomentsParameters:
    """How long skeletons wait for their pixels, and how a camera's period is measured.

    All were set by hand, for cameras of 5 to 90 frames a second; `tests/scenes/overload.py` shows
    how old poses become with them.
    """

    flowing_s: float = 1.0
    """Seconds since a camera's first skeleton, or its last frame, during which its pixels are taken
    to flow, and are waited for."""
    patience: float = 0.9
    """Periods of the camera that a skeleton waits for its frame at the most. What is left of two
    periods, after the one until the next skeleton, is for the skeleton's own way."""
    frames_kept: int = 4
    """Number of frames that are kept for skeletons that arrive later than they do."""
    first_period_s: float = 1.0 / 30.0
    """Seconds from one skeleton to the next that a camera is taken to have before it is known."""
    intervals: int = 30
    """Number of intervals between skeletons whose mean is the camera's period: the mean, since
    skeletons may arrive in bursts."""
    fewest_intervals: int = 8
    """Number of intervals from which on their mean is taken."""
    longest_interval_s: float = 2.0
    """Seconds between skeletons from which on the camera has paused, and is measured anew."""


@dataclass(frozen=True)
class EffortParameters:
    """How a tracker fits its work into the camera's period. Loads are times of steps in periods.

    The effort stays where the load lies between ``least_load`` and ``most_load``; elsewhere it
    changes by the ratio of ``aim_load`` to the load. Whatever part of a step the effort does not
    touch, that never overshoots the aim, so it comes to rest.
    """

    steps: int = 15
    """Number of steps whose median load decides: half a second at 30 Hz."""
    late_steps: int = 5
    """Number of steps whose median load decides already where it is above 1: until then each pose
    is a step older than it could be, as at a start on a busy machine."""
    most_load: float = 0.85
    """Load above which the effort falls."""
    aim_load: float = 0.7
    """Load that a change aims at."""
    least_load: float = 0.5
    """Load below which the effort rises again."""
    least: float = 0.1
    """The least effort: with less a tracker would look at its image in vain."""


DEFAULT_MOMENTS = MomentsParameters()
DEFAULT_EFFORT = EffortParameters()


@dataclass(frozen=True)
class JoiningParameters:
    """How captures of several cameras are joined; all were set by hand."""

    patience: float = 0.6
    """Periods that a moment waits, at the most, for what other cameras captured about then, and for
    frames: cameras that nobody synchronises capture up to half a period later."""
    takeover: float = 0.8
    """Periods that a moment of a later camera of the rig waits for an earlier one's."""
    reach: float = 1.5
    """Periods from a moment within which what a camera captured is of use for it."""
    alive_periods: float = 3.5
    """Periods of a camera without anything from it after which it is not waited for."""
    most_missed: int = 5
    """Number of moments, one after the other, for which a camera came too late, after which it is
    not waited for until it comes in time."""
    odd_clock_s: float = 0.25
    """Seconds by which what a camera captured arrives earlier or later than the others', from
    which on its clock is wrong."""
    restart_s: float = 1.0
    """Seconds that a clock goes back from which on it is another time's: a replay began anew."""
    most_captures: int = 64
    """Number of captures of a camera that wait for a moment."""


DEFAULT_JOINING = JoiningParameters()
