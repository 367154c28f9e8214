"""Every number by which a new recording is watched that can be tuned; all were set by hand."""

from dataclasses import dataclass


@dataclass(frozen=True)
class ViewParameters:
    """Decides what a camera must show of a person, for a recording to be learned from."""

    darkest_grey: float = 30.0
    """Mean luminance, of 255, below which a picture is too dark: edges and colours drown in noise.
    A simulated room has 86 (`inhand simulate`)."""
    least_measured_share: float = 0.25
    """Share of the pixels that must have a depth; simulated rooms have more than half."""
    edge_share: float = 0.03
    """Share of the picture's width within which a hand is at its edge: what it holds is half
    out of it."""
    silent_s: float = 1.0
    """Seconds without a picture, or a skeleton, after which none comes."""
    lasting_s: float = 0.7
    """Seconds that something must be missing, or be there again, until it is said: a joint that
    flickers is no news."""
    look_every_s: float = 0.2
    """Seconds between two pictures that are looked at."""


DEFAULT_VIEW = ViewParameters()
