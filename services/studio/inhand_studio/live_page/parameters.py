"""Every number of the live page that can be tuned."""

from dataclasses import dataclass


@dataclass(frozen=True)
class LiveParameters:
    """Decides what a tab shows of a rig, and how often."""

    wait_s: float = 0.25
    """Seconds after which a tab looks again although nothing came: it then says so."""
    text_period_s: float = 0.25
    """Seconds between two writings of the texts: nobody reads faster."""
    processes_period_s: float = 1.0
    """Seconds between two writings of the processes' table: they report once a second."""
    points_period_s: float = 0.2
    """Seconds between two point clouds: each takes a megabyte."""
    points_step: int = 2
    """Pixels of depth from one point to the next, in rows and in columns."""
    hypotheses_period_s: float = 0.2
    """Seconds from one answer of the trackers on their hypotheses to the next question."""
    poses_missed_s: float = 0.5
    """Seconds without a pose after which pictures no longer wait for theirs."""
    late_poses: int = 16
    """Number of last poses of which the newest frame's is the newest: several trackers of a camera
    are not equally fast."""
    hold_ns: int = 1_000_000_000
    """Nanoseconds for which a pose or a skeleton stays drawn when no newer one comes."""
    silent_s: float = 2.0
    """Seconds without a picture or a skeleton after which that is said."""
    longest_age_ms: float = 600_000.0
    """Age in milliseconds beyond which a clock was set, or two machines' clocks differ."""


DEFAULT_LIVE = LiveParameters()
