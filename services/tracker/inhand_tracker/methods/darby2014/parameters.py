"""Every number of the published methods, and what our reading of the paper adds."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Darby2014Parameters:
    """How particles move, and when they are redrawn (Darby et al. 2014, sections 5.3 to 5.5)."""

    particles: int = 100
    """Number of particles; cost grows with it (`inhand bench tracker`)."""
    advance: float = 1.0
    """Frames that a particle's index advances by, on average, each frame. The printed equation 10
    has 0, its prose "increment, but noisy". With 1 the real golf swings come out in the paper's
    order and clearly better for g-hand (`inhand evaluate`)."""
    index_sigma: float = 1.0
    """Standard deviation, in training frames, of the step of a particle's index (equations 10 and
    11)."""
    rotation_variance: float = np.pi / 16.0
    """Variance over which α, the probability that rotations are redrawn, falls (equation 12)."""
    translation_variance: float = 0.1
    """Variance over which β, the probability that translations are redrawn, falls (equation 13)."""

    # gd-fallback (section 7): the paper proposes "a simple distance threshold" without a figure.
    near_share: float = 0.99
    """Share of the training poses that have a pose of other participants so near that it counts as
    near."""
    asked_poses: int = 512
    """Number of training poses, evenly spaced, that the distance of near ones is measured for."""
    compared_poses: int = 100_000
    """Number of training poses, evenly spaced, that those are compared with."""
    breadth: int = 10
    """Number of training frames, drawn from all, of which a particle takes the likest."""


DEFAULT_DARBY2014 = Darby2014Parameters()


@dataclass(frozen=True)
class EdgeImageParameters:
    """How an image is made ready for the likelihoods (section 5.6); once for all trackers in it."""

    gradient_threshold: float = 100.0
    """Length of the Sobel gradient, in grey levels, from which a pixel is an edge."""
    smoothing_pixels: float = 2.0
    """Standard deviation, in pixels, by which edges are blurred: how far from an edge still counts
    as near."""


DEFAULT_EDGE_IMAGE = EdgeImageParameters()


@dataclass(frozen=True)
class SurfaceParameters:
    """How measured depth is compared with an object's surface (section 7)."""

    farthest_surface_m: float = 0.05
    """Distance in metres from which a measured surface counts as none."""
    pixel_step: int = 3
    """Pixels from one measured point to the next, along rows and columns; others are left out."""


DEFAULT_SURFACE = SurfaceParameters()
