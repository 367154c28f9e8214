"""Every number by which the people that several cameras see become one."""

from dataclasses import dataclass


@dataclass(frozen=True)
class RigParameters:
    """How skeletons of several cameras are matched, fused, and found to disagree.

    `inhand bench rigs` shows what they do. Where nothing else is said a number was set by hand.
    """

    # How sure a camera is of a joint (sightings).
    tracked_m: float = 0.02
    """Standard deviation, in metres and across the line of sight, of a joint that is tracked with
    all confidence."""
    inferred_factor: float = 3.0
    """Factor on it of a joint that is inferred."""
    unsure_factor: float = 3.0
    """Factor on it of a joint with no confidence at all; in between, it grows evenly."""
    along_factor: float = 1.5
    """Factor on it along the line of sight: depth is measured worse than direction."""

    # How joints of several cameras become one (joint_fusion).
    freedom: float = 3.0
    """Degrees of freedom of Student's t, by which joints err: a few are far off."""
    reweightings: int = 4
    """Number of times that joints are weighed anew by how far they are from their mean."""
    expected_m: float = 0.06
    """Standard deviation, in metres, of a joint from where it was expected."""

    # How people of several cameras are matched and followed (people_tracks).
    patience_ns: int = 2_000_000_000
    """Nanoseconds that a person may be out of every view and still be the same one."""
    farthest_m: float = 0.5
    """Mean distance of joints, in metres, beyond which two people are not the same one."""
    drift_m_s: float = 0.5
    """Metres by which that grows with each second for which somebody is out of view."""
    other_id_m: float = 0.15
    """Metres that a camera's other id for a person counts as."""
    same_m: float = 0.25
    """Mean distance of joints, in metres, within which two people of whom no camera sees both are
    one person."""
    same_for_ns: int = 500_000_000
    """Nanoseconds for which they must be that near."""
    velocity_time_s: float = 0.1
    """Time constant, in seconds, of the smoothing of joints' velocities."""
    most_m_s: float = 6.0
    """Greatest speed, in metres a second, at which a joint is expected to go on."""
    longest_step_s: float = 0.1
    """Longest time, in seconds, over which a joint goes on as it went."""

    # How people who are read with left for right are found (people_tracks).
    swapped_ratio: float = 0.5
    """Mean distance of a skeleton's joints with sides exchanged, as a share of that without, below
    which it has them exchanged."""
    swapped_m: float = 0.05
    """Metres by which it must be less."""
    turned_time_s: float = 0.5
    """Seconds, about, for which most cameras must read a person with sides exchanged before it is
    the person who had them exchanged so far."""

    # How places of cameras are learned (placing).
    place_m: float = 0.003
    """Standard deviation, in metres along each axis, of where a camera is of which no calibration
    says how sure it is: with the next one, 5 mm and 0.2° in all."""
    place_rad: float = 0.002
    """The same of its rotation, in radians about each axis."""
    least_place_m: float = 0.0015
    """The least such deviation, whatever a calibration says: cameras and floors move."""
    least_place_rad: float = 0.001
    """The same of the rotation."""
    place_share: float = 0.2
    """Share of what images say of cameras' places that counts: one frame errs as the next does."""
    place_freedom: float = 6.0
    """Degrees of freedom of Student's t, by which moments err: few are far off."""
    body_place_m: float = 0.01
    """Standard deviation, in metres along each axis, by which a camera has people elsewhere than
    they are, however long it sees them."""
    pull_error_m: float = 0.01
    """Metres along each axis, a standard deviation, by which an image alone has an object
    elsewhere than others for other reasons."""
    pull_error_rad: float = 0.1
    """The same of how it is turned, in radians."""
    place_memory_s: float = 300.0
    """Seconds, about, of seeing objects after which what was seen is forgotten."""
    place_most: float = 5.0
    """Number of its calibration's deviations by which a camera may be off by what is learned: the
    root of a sum of six squares."""

    # How a camera that is not where it is said to be is found (agreement).
    compared_every_ns: int = 100_000_000
    """Nanoseconds from one comparison of the cameras to the next."""
    settling_s: float = 1.5
    """Time constant, in seconds, of the mean by which a camera differs from the others."""
    least_compared_s: float = 2.0
    """Seconds for which people are compared before anything is made of it."""
    apart_m: float = 0.08
    """Metres that a camera may differ by, for seconds; skeletons of one person differ by 1 to 3
    centimetres."""
    together_m: float = 0.05
    """Metres that a camera which was left out must not differ by any more."""

    # How a camera that is very far off is found (far_off).
    far_off_s: float = 6.0
    """Seconds for which somebody whom one camera sees is compared with somebody whom others see."""
    alike_m: float = 0.15
    """Metres, root mean square, that joints of one person may differ by, laid on each other."""
    alike_share: float = 0.5
    """The same as a share of what they differ by when their times are exchanged: two people who
    stand are alike at all times, and only one who moves shows that they are one."""


DEFAULT_RIG = RigParameters()
