"""Every number of the prior that can be tuned.

They were chosen on simulated people. A body that was never seen is what most of them are about;
`inhand evaluate` without images shows their worth, and for those of ``PriorParameters``
`inhand bench ablation DATASET --vary prior.FIELD=VALUE`.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class PriorParameters:
    """How predictions are combined."""

    distrust: float = 0.1
    """Share of each prediction's own variance that is added to it: no weight lives on small
    differences."""
    everywhere_share: float = 0.1
    """Share of the covariance over all body poses in the covariance at any of them."""
    farthest_kernel: float = 0.4
    """Kernel to which one that is smaller at all landmarks, as it is for one in a hundred poses of
    people who were not learned from, is stretched: far from what was learned the nearest of it is
    the best guess."""
    most_stretched: float = 3.0
    """Factor, at the most, by which the guess's deviation is stretched as well, and so is that of
    the hold of a strange posture."""
    new_kernel: float = 0.7
    """Kernel below which, at all landmarks, a body is new, the more so the smaller it is: what
    carries the object along then says more than where it was usual."""
    familiar_posture: float = 0.8
    """Kernel to the nearest posture below which one is strange: how people hold the object says
    more there than what they did. Of postures of simulated people who were not learned from 95 %
    are above it, and few of real people's (docs/real_bodies.md)."""
    strange_posture: float = 0.6
    """Kernel to the nearest posture below which nothing but how people hold the object counts."""
    held_doubt: float = 0.094
    """Probability that an object is where people had it in what they did, and not held, however
    strange a posture. One in 10.645 keeps that place within the 90 % region."""


DEFAULT_PRIOR = PriorParameters()


@dataclass(frozen=True)
class PriorLearningParameters:
    """How a prior is learned; `inhand bench tracker` shows what that costs."""

    landmarks: int = 500
    """Number of training frames, evenly spaced, that the regressions rest on."""
    groups: int = 8
    """Number of groups of participants, at the most, that are held out in turn."""
    kernel_width: float = 0.5
    """Width of the Gaussian kernel, as a share of the usual distance between landmarks."""
    ridges: tuple[float, ...] = (0.1, 0.03, 0.01)
    """Variances of the noise over that of the signal, by which a regression is held back: of these
    the one with the least errors on people held out. Kinects' noise asks for the first, joints
    that were measured by markers for the last (`inhand evaluate`, docs/fusion.md)."""
    jitter: float = 1e-4
    """Number added to the diagonal of the landmarks' kernel, so that equal landmarks do no harm."""
    longest_persistence_s: float = 10.0
    """Seconds that an error lasts, at the most."""

    # How what holds an object is learned (hold_learning).
    carried_way_m: float = 0.01
    """Metres that marked vertices go, in the mean, in each of two windows, before a frame and after
    it, in which somebody carries the object."""
    carried_window_s: float = 0.17
    """Seconds that each of these windows lasts."""
    carried_pause_s: float = 0.8
    """Seconds between two such frames within which the object is carried all the time."""
    other_grip_m: float = 0.07
    """Metres from where it is on the object for others, in the median, within which the other hand
    holds it as well: it is 0.04 of bars and clubs, 0.13 and more of what one hand holds."""
    other_holder_ratio: float = 1.1
    """Factor on the errors of a holder that is not the dominant hand: that one keeps its grip where
    the other slides along, which people in training may not have done."""
    upright_holder_ratio: float = 1.7
    """Factor on the errors of a holder that keeps the trunk's directions: where people do the same
    again and again, objects seem to be kept upright that turn with the arm."""


DEFAULT_PRIOR_LEARNING = PriorLearningParameters()
