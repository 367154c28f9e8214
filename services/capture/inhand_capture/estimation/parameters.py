"""Every number by which skeletons are estimated that can be tuned.

Where nothing is said a number was set by hand. ``inhand bench skeletons`` shows what they do.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class BlazePoseParameters:
    """Decides where BlazePose looks for people, and whom it believes."""

    detection_score: float = 0.5
    """Score from which a box of the detector is tried: the network's authors' number."""
    person_score: float = 0.5
    """Probability of a person from which landmarks are believed: the network's authors' number."""
    region_scale: float = 1.25
    """Side of the square that is looked at, in diameters of the circle about a body: the network's
    authors' number."""
    refined_from: float = 0.5
    """Score of a heat map from which its maximum refines a landmark."""
    refined_window: int = 7
    """Side of the window in the heat map that refines a landmark, cells: the network's authors'
    number."""
    empty_period: int = 3
    """Number of pictures, while nobody is in view, in one of which the detector looks."""
    search_period: int = 15
    """Number of pictures, while somebody is in view, in one of which the detector looks for others:
    half a second at 30 Hz."""
    same_person: float = 0.25
    """Mean distance of two people's joints, in lengths of their trunks, below which they are one
    person found twice."""
    most_people: int = 10
    """Number of people that are followed at the most: each costs the landmark network's time."""


DEFAULT_BLAZEPOSE = BlazePoseParameters()
