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
    facing_agreement: float = 0.5
    """Cosine, from how shoulders and hips have lain to how they lie, below which somebody seems to
    have turned round and is looked at a second time."""
    facing_share: float = 0.1
    """Share of one picture in the mean of how shoulders and hips have lain."""
    second_look: float = 0.85
    """Side of the region of a second look, as a share of that of the first."""


DEFAULT_BLAZEPOSE = BlazePoseParameters()


@dataclass(frozen=True)
class CocoParameters:
    """Decides whom of a network of COCO's key points is believed."""

    person_score: float = 0.5
    """Score from which a candidate is a person."""
    same_person: float = 0.6
    """Shared over joint area of two boxes from which they are one person found twice."""
    most_people: int = 10
    """Number of people that are taken at the most, the surest first."""


DEFAULT_COCO = CocoParameters()


@dataclass(frozen=True)
class LiftingParameters:
    """Decides how joints in a picture get their places in space.

    Lengths are in trunks: from the middle of the shoulders to that of the hips as a network sees
    them. They and the conventions are medians over simulated people (`inhand bench skeletons`).
    """

    # Where depth is read.
    window: float = 1.0
    """Radius of the disc in which a joint's depth is read, in radii of its limb."""
    smallest_window: float = 2.0
    largest_window: float = 20.0
    """Bounds of that radius, pixels."""
    gap: float = 0.02
    """Gap between two surfaces' depths in a window, as a share of their distance."""
    fewest_depths: int = 3
    """Number of pixels from which a surface counts."""
    most_surfaces: int = 4
    """Number of surfaces of a window that are considered."""
    nearest_depth_m: float = 0.3
    """Metres before the camera within which no joint is looked for."""

    # How a surface is chosen.
    agreement_m: float = 0.1
    """Deviation, in metres, of joints that agree on the body's distance."""
    trunk_gate_m: float = 0.35
    """Distance, in metres, from where the network expects it, beyond which a surface has no joint
    of the trunk or the head under it."""
    depth_deviation_m: float = 0.12
    """Deviation of the network's depths from one joint of a limb to the next, metres."""
    length_deviation: float = 0.2
    """Deviation of a part's length from the expected one, as a share of it."""
    movement_m: float = 0.15
    """Deviation, in metres, of a joint's depth from one frame to the next."""
    largest_cost: float = 4.0
    """Bound of what a departure costs: a wild one tells no more than a large one."""
    hidden_cost: float = 5.0
    """Cost of taking a joint for hidden, in squared deviations."""
    longest_ratio: float = 2.0
    """Ratio of a part's length to the expected one from which its outer joint is missing: it is not
    this person's, or not where the network says."""
    visible_from: float = 0.5
    """Visibility from which a measured joint is tracked; others are inferred."""

    # Radii of limbs: depth gives the skin, and the joint lies below it. Metres.
    head_radius_m: float = 0.08
    shoulder_radius_m: float = 0.05
    elbow_radius_m: float = 0.04
    wrist_radius_m: float = 0.03
    hand_radius_m: float = 0.033
    hip_radius_m: float = 0.095
    knee_radius_m: float = 0.05
    ankle_radius_m: float = 0.05
    foot_radius_m: float = 0.03

    # Usual lengths, in trunks, until somebody's own are known.
    upper_arm: float = 0.59
    forearm: float = 0.54
    hand: float = 0.155
    thigh: float = 0.86
    shank: float = 0.79
    foot: float = 0.33
    own_lengths_from: int = 10
    """Number of frames that measured a part from which on its own median stands for the usual
    length."""
    length_frames: int = 300
    """Number of frames that such a median is over: 10 s at 30 Hz."""
    usual_trunk_m: float = 0.5
    """Length of a usual trunk, metres, from which follows how large a window is."""
    shortest_trunk_m: float = 0.2
    longest_trunk_m: float = 0.9
    """Bounds of a trunk's length, metres: what is smaller or larger is no person."""

    # Where Kinect's joints lie by those that networks know.
    hip_centre: float = 0.14
    spine: float = 0.30
    shoulder_centre: float = 1.07
    """Places of the trunk's joints on the line from the middle of the hips to that of the
    shoulders."""
    shoulders_aside: float = 1.1
    """Distance of the shoulders from their middle, over that in the network's convention."""
    elbow_along: float = 0.12
    """Way of the elbow beyond the network's, in its upper arms."""
    ankle_along: float = 0.04
    """Way of the ankle beyond the network's, in its shanks."""
    head: float = 1.45
    """Place of the head on the line from the middle of the hips to that of the shoulders, for
    networks that know no head."""
    head_above: float = 0.035
    """Way of the head's middle above that of the ears, in trunks."""
    foot_above: float = 0.045
    """Way of the foot above its tip, in shanks and along them."""


DEFAULT_LIFTING = LiftingParameters()


@dataclass(frozen=True)
class FollowingParameters:
    """Decides who is who from frame to frame, and how joints are smoothed."""

    # Who is who (people).
    reach_m: float = 0.3
    """Distance that a body's middle may be from where it was, metres, besides its way since."""
    speed_m: float = 2.0
    """Greatest speed of a body's middle, metres a second."""
    farthest_m: float = 1.0
    """Distance beyond which somebody is another person, however long ago."""
    forgotten_s: float = 2.0
    """Seconds out of view after which a person is forgotten: whoever comes back is somebody new."""
    remembered_s: float = 0.3
    """Seconds after which joints of before say nothing of where joints are now."""

    # Which side is which (sides).
    across_s: float = 0.3
    """Time constant of the mean of how shoulders and hips lie, seconds."""
    across_m: float = 0.05
    """Distance of left from right, metres, from which they say that sides are exchanged: whoever is
    seen from the side has hardly any in the picture."""
    longest_exchange_s: float = 0.7
    """Seconds after which a network that exchanges sides is believed, unless toes contradict it."""
    toes_m: float = 0.03
    """Distance of toes before ankles, or behind them, from which they say where a body faces,
    metres."""
    toes_s: float = 0.1
    """Time constant of that distance's mean, seconds."""

    # How joints are smoothed (one_euro; Casiez et al. 2012).
    slowest_hz: float = 1.5
    """Frequency up to which a joint at rest is followed."""
    quicker: float = 4.0
    """Rise of that frequency with speed, Hz for each metre a second."""
    speed_hz: float = 1.5
    """Frequency up to which the speed is followed."""


DEFAULT_FOLLOWING = FollowingParameters()
