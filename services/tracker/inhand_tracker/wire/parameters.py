"""Every number by which skeletons wait for their pixels."""

from dataclasses import dataclass


@dataclass(frozen=True)
class PairingParameters:
    """Decides how long a skeleton waits for its pixels. All were set by hand."""

    flowing_s: float = 1.0
    """Seconds since the last frame during which pixels are taken to flow, and are waited for."""
    longest_wait_s: float = 0.05
    """Seconds that a skeleton waits at the most; they add to a pose's latency."""
    frames_kept: int = 4
    """Number of frames that are kept for skeletons that arrive later."""


DEFAULT_PAIRING = PairingParameters()
