"""What is chosen in a calibration from people.

The numbers were chosen on seeds that `inhand bench calibration` does not use.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class MovementParameters:
    """How skeletons become smooth movements (``tracks``)."""

    step_s: float = 0.02
    """Time from one node of a movement to the next: lines between nodes miss a foot's way by
    0.5 mm."""
    kernel_s: float = 0.05
    """Deviation of the Gaussian kernel of the local lines, seconds: wide enough for 15 Hz."""
    reach_s: float = 0.15
    """Time on either side within which frames count for a node."""
    least_support: float = 0.6
    """Sum of kernel weights times confidences below which a joint is unknown at a node."""
    most_aside_s: float = 0.05
    """Distance in time of the middle of a node's frames from the node, at most: else there is a
    gap on one side of it."""
    least_confidence: float = 0.15
    """Confidence below which a joint counts as missing."""
    most_gap_s: float = 0.5
    """Gap after which a person's movement begins anew."""
    most_jump_m: float = 0.5
    """Way of the hips from frame to frame after which it is somebody else's movement."""
    least_s: float = 2.0
    """Length of the shortest movement that is used."""
    most_tracks: int = 24
    """Number of a camera's movements that are used, the longest."""
    least_share_of_way: float = 0.1
    """Spread of the hips below which, as a share of the most moving person's in this camera, a
    figure is left out: what hangs or sits there for the whole time agrees with itself at every
    clock offset."""


@dataclass(frozen=True)
class AgreementParameters:
    """When two cameras see the same person (``agreement``)."""

    step_s: float = 0.1
    """Time from one moment at which cameras are compared to the next."""
    gate_m: float = 0.3
    """Distance of two figures, root mean square over their joints, up to which they may be one
    person."""
    most_m: float = 0.6
    """Distance of two joints beyond which more makes no difference."""
    least_joints: int = 5
    """Number of points, of ten, that both must see of a person."""


@dataclass(frozen=True)
class RefinementParameters:
    """How all is refined together (``refinement``)."""

    iterations: int = 15
    """Number of iterations at the most."""
    freedom: float = 4.0
    """Degrees of freedom of the Student distribution that residuals are taken to have."""
    least_deviation_m: float = 0.005
    """Deviation of a joint below which none is believed to be."""
    surface_m: float = 0.015
    """Deviation of how much nearer to the camera than the truth people are seen, in all cameras
    alike: skeleton trackers see the skin or shirt in place of the bone."""
    surface_difference_m: float = 0.005
    """Deviation between cameras of the same."""
    drift_ppm: float = 50.0
    """Deviation of a clock's drift: crystals are made within 20 to 100 parts per million."""
    block_s: float = 5.0
    """Length of the blocks of time that are taken to err independently: a walker's errors are
    forgotten in about so long."""
    covariance_factor: float = 2.5
    """Factor on the scatter by clusters: joints and times are not all that errors share, a pose
    that comes back is misread as before."""
    delay_share: float = 0.3
    """Share of the time from frame to frame by which a tracker's filter delays a skeleton, or is
    ahead: cameras of unlike rates are so much less sure of their clocks. The simulated Kinect's
    says 9 ms more at 15 Hz than at 30 Hz."""
    clock_s: float = 0.001
    """Deviation of a clock offset that no length of a walk brings down."""
    rest_step: float = 1e-5
    """Step, metres, radians or seconds, below which it is done."""


@dataclass(frozen=True)
class SearchParameters:
    """How two cameras' movements are laid over each other (``common_movement``)."""

    step_s: float = 0.1
    """Step of the clock offsets that are tried: at 1 m/s its half is 5 cm."""
    least_overlap_s: float = 8.0
    """Time for which two movements must overlap at a clock offset that is tried, or all of the
    shorter one, if that is less."""
    pairs: int = 16
    """Number of pairs of movements that are tried, those that overlap longest."""
    hypotheses: int = 10
    """Number of offsets of a pair of movements that are kept, the best."""
    refined: int = 4
    """Number of hypotheses for two cameras that are refined before the best is chosen."""
    agreement: AgreementParameters = AgreementParameters(step_s=0.3)
    """How cameras are compared while hypotheses are."""
    refinement: RefinementParameters = RefinementParameters(iterations=4)
    """How hypotheses are refined."""
    apart_s: float = 0.25
    """Difference of clock offset from which two hypotheses are not the same one."""
    apart_rad: float = float(np.deg2rad(15.0))
    """Difference of rotation from which they are not the same one."""
    block_s: float = 3.0
    """Length of the blocks by which it is judged whether one is better than the other."""
    surely: float = 3.0
    """Standard errors by which the best must be better than any other hypothesis."""


@dataclass(frozen=True)
class AcceptanceParameters:
    """What a calibration must reach, or it is an error."""

    least_s: float = 15.0
    """Time for which a camera must see people."""
    least_common_s: float = 8.0
    """Time for which two cameras must see the same person."""
    least_share: float = 0.3
    """Share of the time in which both see people for which they must agree."""
    most_clock_s: float = 0.02
    """Deviation of a clock offset, at most."""
    most_translation_m: float = 0.1
    """Deviation of a camera's place along any axis, at most."""
    most_rotation_rad: float = float(np.deg2rad(4.0))
    """Deviation of its rotation about any axis, at most."""
    scale_share: float = 0.02
    """Difference of two cameras' sizes of the same person from which it is said."""


@dataclass(frozen=True)
class FloorParameters:
    """How the floor is found (``standing_floor``)."""

    still_m_s: float = 0.2
    """Speed of a foot that rests, at most."""
    lower_m: float = 0.05
    """Height above the other foot of a foot that rests, at most."""
    stay_m: float = 0.25
    """Distance within which feet that rest are one piece of evidence."""
    least_places: int = 3
    """Number of places where feet rested without which there is no floor."""
    ankle_share: float = 0.0437
    """Height of an ankle above the floor as a share of its distance from the middle of the head:
    0.039 of 0.893 statures (Drillis and Contini, 1966)."""
    foot_deviation_m: float = 0.025
    """Deviation of a place where a foot rested from the floor."""
    ankle_deviation_m: float = 0.015
    """Deviation of the height of skeletons' ankles above the floor that no number of places
    brings down."""
    lean_rad: float = float(np.deg2rad(4.0))
    """Deviation of people's way from feet to shoulders from up."""
    surest_rad: float = float(np.deg2rad(0.3))
    """Deviation of up below which no number of places brings it."""


@dataclass(frozen=True)
class DisagreementParameters:
    """When cameras disagree (``disagreement``)."""

    moved_m: float = 0.04
    """Distance by which people appear elsewhere from which on a camera has moved."""
    turned_rad: float = float(np.deg2rad(2.0))
    """Turn from which on a camera has moved."""
    clock_s: float = 0.03
    """Change of a clock offset from which on a clock has changed."""
    surely: float = 3.0
    """Standard deviations that a change must have."""
    explained: float = 0.3
    """Share of the moments at which the calibration must still match people, at least, or all is
    sought anew."""
    explained_m: float = 0.1
    """Distance of figures, at most, at which it does."""
    least_s: float = 3.0
    """Time for which two cameras must see the same person for anything to be said."""


@dataclass(frozen=True)
class PeopleCalibrationParameters:
    """All that is chosen in a calibration from people."""

    movement: MovementParameters = MovementParameters()
    search: SearchParameters = SearchParameters()
    agreement: AgreementParameters = AgreementParameters()
    refinement: RefinementParameters = RefinementParameters()
    acceptance: AcceptanceParameters = AcceptanceParameters()
    floor: FloorParameters = FloorParameters()
    disagreement: DisagreementParameters = DisagreementParameters()


DEFAULT_PEOPLE_CALIBRATION = PeopleCalibrationParameters()
