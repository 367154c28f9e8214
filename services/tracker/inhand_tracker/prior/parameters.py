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
    """Factor, at the most, by which the guess's deviation is stretched as well."""
    new_kernel: float = 0.7
    """Kernel below which, at all landmarks, a body is new, the more so the smaller it is: what
    carries the object along then says more than where it was usual."""


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
    ridge: float = 0.1
    """Variance of the noise over that of the signal: how much regression is held back."""
    jitter: float = 1e-4
    """Number added to the diagonal of the landmarks' kernel, so that equal landmarks do no harm."""
    longest_persistence_s: float = 10.0
    """Seconds that an error lasts, at the most."""


DEFAULT_PRIOR_LEARNING = PriorLearningParameters()
