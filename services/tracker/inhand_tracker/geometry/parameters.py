"""Every number of geometry that can be tuned: how an estimate ages."""

from dataclasses import dataclass


@dataclass(frozen=True)
class AgeingParameters:
    """Decides how fast an estimate ages while the person is out of view.

    All three were set by hand; no measurement stands behind them.
    """

    lost_after_ns: int = 1_000_000_000
    """Nanoseconds out of view after which an object is declared lost; confidence falls to 0 until
    then."""
    speed_m_s: float = 0.5
    """Standard deviation, in m/s, of the speed of an object that nobody sees: that of a hand at
    work."""
    turn_rate_rad_s: float = 2.0
    """Standard deviation, in rad/s, of the turning of an object that nobody sees."""


DEFAULT_AGEING = AgeingParameters()
