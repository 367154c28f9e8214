"""Every number by which bodies are read that can be tuned.

Where nothing is said a number was set by hand.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class BodyParameters:
    """Decides how a person's joints are read, and what of their last moments is kept."""

    # What anchors rest on (anchors).
    straight_arm: float = 0.15
    """Length, in metres, of the trunk's upwards direction beside that of the upper arm, where they
    give a forearm's plane: a straight arm shows none."""

    # How joints are read (reader, skeleton).
    farthest_joint_m: float = 1000.0
    """Metres along an axis of the camera beyond which a joint is taken to be missing: no room is as
    large."""
    height_frames: int = 300
    """Number of frames whose part lengths a person's height comes from: 10 s at 30 Hz."""
    wild_ratio: float = 2.0
    """Ratio, either way, of a part's length to the expected one from which a joint is wild."""
    learned_poses: int = 1000
    """Number of body poses, about, that the usual proportions come from."""

    # How conventions of skeletons are told from postures and people (convention_map).
    upright_cosine: float = 0.82
    """Cosine of the angle, 35 degrees, within which thighs and upper arms hang below the trunk of
    somebody who stands and does not reach up: other postures say nothing of the trunk's joints."""
    least_measured: int = 45
    """Number of the last ``height_frames`` frames from which a measure counts: 1.5 s at 30 Hz."""
    measured_every: int = 15
    """Number of frames after which what differs is reckoned anew."""
    apart_deviations: float = 3.0
    """Root mean square of what measures differ by, in deviations of people of one convention, above
    which two bodies are of two conventions. Of recordings of simulated people all are below 2.3,
    and of UTD-MHAD's half are above 3.5."""
    patience: int = 150
    """Number of frames, 5 s at 30 Hz, after which it is said that nobody shows a convention."""

    # What a window keeps (window). Priors are learned with lags and memories: with others, train
    # again.
    lags_s: tuple[float, ...] = (0.13, 0.33)
    """Seconds back to the poses that the present one is compared with."""
    memories_s: tuple[float, ...] = (1.0, 3.0)
    """Time constants, in seconds, of the means of where hands and head have been."""
    gap_ns: int = 500_000_000
    """Nanoseconds between frames beyond which nothing of before counts."""


DEFAULT_BODY = BodyParameters()
