"""Every number by which skeletons wait for their pixels."""

from dataclasses import dataclass


@dataclass(frozen=True)
class PairingParameters:
    """How long a skeleton waits for its pixels, and when it is too old.

    All were set by hand, for 15 to 30 Hz.
    """

    flowing_s: float = 1.0
    """Seconds since the last frame during which pixels are taken to flow, and are waited for."""
    longest_wait_s: float = 0.05
    """Seconds that a skeleton waits at the most; they add to a pose's latency."""
    frames_kept: int = 4
    """Number of frames that are kept for skeletons that arrive later."""
    most_waiting: int = 3
    """Number of skeletons that may wait while pixels flow: with more the tracker is behind, and the
    newest one whose frame is there is next. A hiccup of a tenth of a second loses none."""


DEFAULT_PAIRING = PairingParameters()
