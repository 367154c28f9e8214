"""Every number of labelling that can be tuned.

Those of assistance were chosen on the people of one simulated dataset, and docs/labels.md shows
what they do on another (`inhand bench labels DATASET`).
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class LabellingParameters:
    """Decides how poses between keyframes are found."""

    # Which frames get a pose (interpolation).
    longest_step_s: float = 0.5
    """Seconds from one frame to the next beyond which nothing is known of the way between two
    keyframes: the camera stood still, and the object need not have."""

    # What is expected of an object between keyframes (expectations, smoothing).
    keyframe_m: float = 0.005
    """Root mean square in metres of a person's inaccuracy in placing a keyframe."""
    keyframe_rad: float = float(np.deg2rad(3.0))
    """Root mean square in radians of a person's inaccuracy in turning it."""
    near_m: float = 0.15
    """Root mean square in metres by which an object is usually off the interpolated way a second
    from both keyframes; it grows with the square root of time."""
    near_rad: float = 0.2
    """Root mean square in radians of the same."""
    drift_m: float = 0.3
    """Root mean square in metres by which an object leaves, within a second, a way beside the
    interpolated one; it grows with the square root of time."""
    drift_rad: float = 0.5
    """Root mean square in radians of the same."""
    far_factor: float = 5.0
    """Number of times as far that some objects leave the way: a swing does within a second."""
    acceleration_m: float = 5.0
    """Usual acceleration of an object away from the interpolated way, in m/s²."""
    acceleration_rad: float = 20.0
    """Usual acceleration of its turning, in rad/s²."""
    smooth_drift_m: float = 1.0
    """Root mean square in metres by which it leaves the way within a second, where all frames are
    smoothed together."""
    smooth_drift_rad: float = 2.5
    """Root mean square in radians of the same."""
    sight_share: float = 1.0
    """Share of all these distances that an object goes along the line of sight."""
    unmeasured_sight_share: float = 0.5
    """The same of an object of which hardly any depth is measured: an image shows that way by the
    object's size alone, often less exactly than interpolation does."""
    smoothing_steps: int = 5
    """Number of Gauss-Newton steps in which a stretch is smoothed."""

    # What is clicked on (measured_depth, pose_start).
    click_pixels: int = 3
    """Pixels around the one that was clicked on whose depths count."""
    click_depth_m: float = 0.015
    """Metres from one depth to the next around a pixel within which both are of one surface."""
    click_share: float = 0.15
    """Least share of the depths around a pixel that makes a surface, and no stray ones."""
    click_off_m: float = 0.03
    """Metres that a point may be off where it was clicked on: sensors and hands err."""
    click_off_share: float = 0.15
    """Share of the points' distance from their middle that it may be off beside that."""
    exchanged_m: float = 0.01
    """Metres that a point has to be off before another order of the points is thought of."""
    exchanged_share: float = 0.4
    """Share of that which is left in another order where it was the one that was meant."""
    least_apart_m: float = 0.005
    """Metres from one point to another below which both are the same."""
    least_aside_share: float = 0.1
    """Share of their extent that points have to lie aside of one line."""
    placing_steps: int = 4
    """Number of steps in which the surface of an object is brought to the depth of a pixel."""

    # What one pose that was given is worth (pose_refinement).
    given_m: float = 0.03
    """Root mean square in metres of a pose that a person set by eye, or by clicks."""
    given_rad: float = float(np.deg2rad(12.0))
    """Root mean square in radians of the same."""

    # How much stays in memory (stretch_views).
    views_kept: int = 60
    """Number of images between keyframes that stay in memory, some 8 MB each of 640 × 480; of
    longer stretches the others are read up to three times."""

    # How an image is looked at (looking, assistance).
    drawn: int = 300
    """Number of poses that are tried about the expected ones."""
    refined: int = 3
    """Number of these, the likeliest ones, that are refined."""
    image_trust: float = 1.0
    """Share of a sharp image's log-likelihood that counts where poses are chosen; with 0.4, as in
    fusion, swings are lost."""
    refinement_trust: float = 1.0
    """Share of a sharp image's information that refinement keeps."""
    blurred_pixels: float = 20.0
    """Pixels that an object goes from frame to frame where its image counts half, as in fusion."""
    most_disagreement: float = 2.0
    """Standard deviations that both directions may be apart, beyond which each is tried alone."""
    same_m: float = 0.01
    """Metres within which two refined poses are the same, and the image says as much of one as of
    the other."""
    same_rad: float = 0.1
    """Radians of the same."""


DEFAULT_LABELLING = LabellingParameters()
