"""Every number by which people are followed and identified."""

from dataclasses import dataclass


@dataclass(frozen=True)
class PeopleParameters:
    """Decides how long people are waited for, and who is taken for a person of before.

    `pytest tests/lab/world/test_crossing.py` shows what they do: of two people who cross, nobody
    may be taken for the other. Where nothing else is said a number was set by hand.
    """

    patience_ns: int = 2_000_000_000
    """Nanoseconds that a person may be out of view and still be the same one. One in twenty
    simulated people who cross is lost for just over a second."""

    farthest_m: float = 0.6
    """Metres from where somebody was expected beyond which it is another person."""
    drift_m_s: float = 0.5
    """Metres by which ``farthest_m`` and ``position_sigma_m`` grow with each second that somebody
    is out of view."""
    position_sigma_m: float = 0.08
    """Standard deviation, in metres, of a person's place from where it was expected."""
    length_sigma: float = 0.06
    """Standard deviation of the mean difference of the logarithms of bone lengths."""
    other_id_cost: float = 2.0
    """Negative log-probability that the camera calls the same person by another id."""

    velocity_time_s: float = 0.15
    """Time constant, in seconds, of the smoothing of a person's velocity, by which the next place
    is expected."""
    length_frames: int = 60
    """Number of frames, about, that bone lengths are averaged over."""


DEFAULT_PEOPLE = PeopleParameters()
