"""Every number of chaos that can be tuned; `inhand chaos` shows what they come to."""

from dataclasses import dataclass


@dataclass(frozen=True)
class ChaosParameters:
    """How long a rig is watched, and what it promises."""

    interaction: str = "drinkFromMug"
    """What the simulated person does meanwhile."""
    up_within_s: float = 90.0
    """Seconds in which poses flow after a start, kernels compiled."""
    well_s: float = 5.0
    """Seconds that a rig is watched before a fault: what is usual is learned from them."""
    watched_s: float = 12.0
    """Seconds that it is watched after a fault's cause has ended."""
    back_within_s: float = 3.0
    """Seconds after the cause's end within which poses flow again."""
    age_normal_within_s: float = 5.0
    """Seconds after the cause's end within which poses are as old as usual again."""
    usual_age_ratio: float = 1.5
    """Times the usual median age that the poses of a second may be old and still be normal."""
    usual_age_more_ms: float = 10.0
    """Milliseconds that they may be older still, as machines are shared."""
    unrecorded_before_s: float = 1.0
    """Seconds of what was captured before a fault that may be in no recording."""
    window_s: float = 1.0
    """Seconds over which a median age is taken."""
    flood_messages: int = 20_000
    """Number of malformed messages, and of those of other releases, over all streams."""
    flood_pause_every: int = 200
    """Number of messages after which a flood pauses: the rig is attacked, not the link."""
    most_grown_mb: float = 50.0
    """Megabytes by which a process may have grown when a fault is over."""
    huge_bytes: int = 32 << 20
    """Bytes of a message that is far too large."""
    huge_messages: int = 3
    """Number of them, on each stream."""
    soak_every_s: float = 60.0
    """Seconds from one fault of a soak to the next."""
    reading_s: float = 2.0
    """Seconds between two readings of what processes take."""
    unsettled_share: float = 1.0 / 3.0
    """Share of a process's life, at its begin, that says nothing of growth."""
    window_readings: int = 15
    """Number of readings over which a median is taken at both ends of a life."""
    most_gained: int = 3
    """Number of handles, or threads, that a process may have more at its end: pools come and go."""
    recordings_kept: int = 2
    """Number of files that a soak leaves to its recorder."""
    recording_bytes: str = "256 MiB"
    """Size of each."""


DEFAULT_CHAOS = ChaosParameters()
