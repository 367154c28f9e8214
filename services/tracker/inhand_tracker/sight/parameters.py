"""Every number of sight that can be tuned.

The same numbers serve every object. They were chosen on simulated frames and checked on real ones
(`inhand bench likelihood SOURCE`); what one of them is worth in tracking shows
`inhand bench ablation DATASET --vary sight.FIELD=VALUE`. Those of appearance are used in training.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class SightParameters:
    """How a frame is read, and how poses are weighed by it and refined."""

    # How the terms of the likelihood count (sight).
    edges_weight: float = 4.5
    """Number of independent points that the edges along the outline are worth."""
    region_weight: float = 13.0
    """Number of independent points that the colours on both sides of the outline are worth."""
    interior_weight: float = 6.0
    """Number of independent points that the colours all over the surface are worth."""
    depth_weight: float = 5.0
    """Number of independent points that the surface's measured depths are worth."""
    least_visible: float = 0.1
    """Share of a pose's points below which no more is made of the few that are visible."""
    fewest_visible: float = 1.0
    """Number of poses that must be visible before poses out of view are compared with them."""

    # How a pose is weighed (kernels/weigh).
    limb_weight: float = 0.5
    """Share of its weight that an edge keeps where a limb may cover the object."""
    covered_m: float = 0.02
    """Metres, beside twice the sensor's noise, by which a nearer measurement covers a point."""
    usual_pixels: float = 60.0
    """Size in pixels of an object whose outline is looked at just as ``OUTLINE_PIXELS`` says."""
    least_outline_scale: float = 0.6
    """Least factor on ``OUTLINE_PIXELS``, for objects that are small in the image."""
    most_outline_scale: float = 2.5
    """Greatest factor on ``OUTLINE_PIXELS``, for objects that are large in the image."""
    least_interior_scale: float = 0.3
    """Least factor on the term ``interior``, for objects that are small in the image."""
    most_interior_scale: float = 3.0
    """Greatest factor on the term ``interior``, for objects that are large in the image."""
    thinning: int = 2
    """Number of points of which one is looked at where many poses are weighed, and in the first
    steps of refinement."""
    fewest_in_thread: int = 500
    """Number of poses for which another thread is worth its start (`inhand bench tracker`)."""

    # How a depth sensor measures (depth_table, kernels/depth_noise).
    depth_noise_m: float = 0.003
    """Standard deviation, in metres, of a depth measured close by: structured light."""
    depth_noise_per_m: float = 0.0025
    """Growth of that deviation with the square of the distance, in metres for each square metre."""
    clutter_per_m: float = 0.5
    """Density, for each metre, of depths that are measured where the object is not."""
    background_measured: float = 0.9
    """Share of the background of which a depth is measured."""
    least_behind: float = 0.02
    """Least share of the object's surface of which something behind it is measured, by error."""
    least_returned: float = 0.5
    """Share of the surface that returns depth below which depth says nothing: what is measured is
    then the hand around the object."""

    # How another light is known (light). Around people in 66 simulated rooms half of
    # log(red / blue) deviates by 0.03, 0.08 at the most; what it is worth shows
    # `inhand recognise --light`.
    same_light: float = 0.09
    """Difference of half the log(red / blue) from training's up to which it is a room's own."""
    light_ramp: float = 0.018
    """Width beyond that difference over which more and more of it is the light's, up to all."""
    light_rate: float = 0.25
    """Share of the newest image in what is known of the light."""
    person_m: float = 0.5
    """Metres before and behind a person's middle joint within which nothing is surroundings."""
    fewest_surroundings: int = 100
    """Number of samples around the person below which they say nothing of the light."""
    light_samples: int = 80
    """Number of samples, about, in a row of an image."""
    darkest: int = 8
    """Level from which each of red, green and blue of a sample is measured well."""
    brightest: int = 249
    """Level up to which each of them is."""
    tint_cells: int = 24
    """Number of cells, each way, of tints by log(red / green) and log(blue / green)."""
    widest_tint: float = 1.0
    """Greatest such logarithm, either way; what is more colourful counts as so much."""
    rare_tint_share: float = 1e-5
    """Share of the samples from which on a tint counts by the logarithm of its share."""

    # How colours speak (colours, view).
    smoothing_levels: float = 0.8
    """Standard deviation, in levels of colour, by which a histogram is smoothed."""
    object_floor: float = 1e-5
    """Probability of a colour that was not seen on the object."""
    around_floor: float = 2e-5
    """Probability of a colour that was not seen around the object; it is greater, as such a colour
    belongs to the rest of the world rather than to the object."""
    most_log_odds: float = 3.0
    """Bound on the log-odds that one colour may give."""
    colour_certainty: float = 0.8
    """Share of pixels that lie where their colour says; the others lie on the other side."""
    limb_share: float = 0.25
    """Share of what a colour says against the object that counts where a hand may cover it."""

    # How edges are found and speak (oriented_edges).
    edge_gradient: float = 50.0
    """Least response of Sobel's operator on an edge: about 12 grey levels across it."""
    edge_agreement_deg: float = 33.75
    """Greatest angle, in degrees, between an edge's normal and that of a channel it counts for."""
    matched_pixels: float = 1.3
    """Standard deviation, in pixels, of an edge's distance from the boundary that it belongs to."""
    matched_share: float = 0.6
    """Share of a boundary's points that show an edge."""

    # What limbs cover (limbs).
    forearm_m: float = 0.05
    """Radius of a forearm, in metres, with the errors of wrist and elbow."""
    hand_m: float = 0.08
    """Radius of a hand, in metres, with the errors of its joints."""
    fingers_m: float = 0.06
    """Metres that fingers reach beyond the joint of the hand."""
    limb_depth_m: float = 0.15
    """Metres before and behind a limb within which a measured depth may be the limb's."""

    # How poses are refined (refinement, kernels/gather).
    refinement_steps: int = 6
    """Number of Gauss-Newton steps."""
    thin_steps: int = 4
    """Number of steps, of those, that look at one point in ``thinning`` only."""
    last_reach: float = 0.12
    """Share of the first step's reach that is left for the last one."""
    reach_m: float = 0.05
    """Metres that a pose may be off before the first step, where no prior says more."""
    reach_rad: float = 0.2
    """Radians that a pose may be off before the first step, where no prior says more."""
    outline_point_weight: float = 0.2
    """Share of its information that a point of the outline keeps; neighbours are not
    independent."""
    surface_point_weight: float = 1.0
    """Share of its information that a point of the surface keeps."""
    outline_samples: int = 6
    """Number of samples on either side of a point of the outline, across it."""
    least_step_pixels: float = 0.5
    """Least distance, in pixels, from one of those samples to the next."""
    widest_edge_step: float = 2.5
    """Distance, in pixels, between samples beyond which edges would be missed and do not count."""
    contour_error_m: float = 0.002
    """Standard deviation, in metres, of an outline that is taken from the nearest direction, and
    as if seen from far away."""
    common_pixels: float = 0.5
    """Standard deviation, in pixels, of an error that all of an outline has, outwards or inwards:
    blur and shade, which make an object nearer or farther away."""
    mixed_steps: int = 3
    """Number of further steps, in which the outline of what is wide enough is where the colours on
    its two sides mix (kernels/mixed_offset)."""
    mixed_reach_pixels: float = 4.0
    """How far these colours are looked at, in pixels, on either side."""
    mixed_least_pixels: float = 4.5
    """Least width, in pixels, of an object and of the gap beside it whose colours show unmixed."""
    mixed_contrast: float = 40.0
    """Least distance of these colours, in levels of red, green and blue."""
    mixed_variance: float = 0.1
    """Variance, in pixels², of where they mix, on lines without anything else."""
    mixed_gain: float = 3.0
    """How much more that counts than where an outline is by histograms and edges."""
    in_front_per_m: float = 3.0
    """Density, for each metre, of other surfaces that are measured just before the object's."""
    behind_per_m: float = 1.5
    """Density, for each metre, of other surfaces that are measured just behind the object's."""
    surface_colour_weight: float = 3.0
    """Weight of a pixel's colour in whether its depth is the object's or another surface's."""
    surface_limb_factor: float = 20.0
    """Factor on the odds of another surface where a limb may be."""
    information_share: float = 0.25
    """Share of the information added up in refinement that holds in fact, measured on simulated
    frames: what points say is not independent."""
    damping_per_m2: float = 100.0
    """Information, for each square metre, that keeps a pose in place where nothing is visible: a
    standard deviation of 10 cm."""
    damping_per_rad2: float = 1.0
    """Information, for each square radian, that keeps a pose's turn where nothing is visible: a
    standard deviation of 1 rad."""

    # How an object's appearance is learned (appearance).
    margin_sizes: float = 1.0
    """Width, in sizes of the object, of the surroundings whose colours are learned."""
    least_margin_pixels: float = 8.0
    """Least width of these surroundings, in pixels."""
    aside_m: float = 0.05
    """Metres before or behind the object's surface from which on a depth is not the object's; wider
    than ``covered_m``, as true poses of training err too."""
    fewest_pixels: int = 200
    """Number of pixels below which a histogram of colours is not believed."""
    most_covered: float = 0.8
    """Greatest share of an object's pixels that is ascribed to fingers over it."""
    usual_limb_ratio: float = 20.0
    """Number of times that the commonest colour of limbs may be commoner than one that is still
    usual for them."""
    returned: float = 0.9
    """Share of the surface that returns depth, where training showed no depth."""
    behind: float = 0.05
    """Share of the surface of which something behind is measured, where training showed no
    depth."""


DEFAULT_SIGHT = SightParameters()
