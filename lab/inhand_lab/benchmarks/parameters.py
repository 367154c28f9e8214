"""Every number of the benchmarks that can be tuned: on whom and on how much each measures.

`inhand bench tracker`, `training`, and `likelihood` show what they come to. Simulated people
drink from a mug in all of them.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class FramePeopleParameters:
    """The simulated people on whom whole frames are timed; the first is tracked, the others are
    learned from."""

    seed: int = 0
    """Seed of the simulated people."""
    people: int = 4
    """Number of simulated people."""
    frames: int = 120
    """Number of frames of each recording."""


@dataclass(frozen=True)
class ComparisonParameters:
    """How this code is compared with another checkout's."""

    people: FramePeopleParameters = FramePeopleParameters()
    """Who is tracked and learned from."""
    interactions: tuple[str, ...] = ("drinkFromMug", "hammerNail")
    """What is learned; the first is what the tracked person does."""
    turns: int = 5
    """Number of times that each code is measured."""
    first_frames: int = 15
    """Number of frames at the beginning that do not count: what is compiled is loaded then."""


@dataclass(frozen=True)
class FrameCostParameters:
    """Which frames are timed by their stages, and by the objects and people that are watched."""

    people: FramePeopleParameters = FramePeopleParameters()
    """Who is tracked and learned from."""
    interactions: tuple[str, ...] = ("drinkFromMug", "hammerNail", "answerPhone", "paintWall")
    """What is learned; the first is what the tracked person does."""
    object_counts: tuple[int, ...] = (1, 2, 4)
    """Numbers of objects that are watched of each person."""
    people_counts: tuple[int, ...] = (1, 2)
    """Numbers of people that are watched."""
    aside_m: float = 0.7
    """Distance in metres of the second person from the first one, to the right."""
    first_frames: int = 15
    """Number of frames at the beginning that do not count: what is compiled is loaded then."""
    frame_rate: float = 30.0
    """Frames a second for which the cores in use are given."""


@dataclass(frozen=True)
class FusionCostParameters:
    """From whom fusion's prior is learned, and on what its frames are timed."""

    seed: int = 0
    """Seed of the simulated people."""
    people: int = 4
    """Number of simulated people; the one whose number comes next is tracked."""
    frames: int = 250
    """Number of frames of each person: 1,000 together."""
    sizes: tuple[int, ...] = (1_000, 10_000, 100_000)
    """Numbers of labelled frames that a prior is learned from."""
    noise_m: float = 0.01
    """Standard deviation in metres of the noise with which people are repeated as others."""
    first_shown: int = 60
    """First frame that is timed: the mug is about to be taken."""
    last_shown: int = 90
    """Frame before which the timing ends."""
    frame_ns: int = 33_333_333
    """Time from one frame to the next, in nanoseconds: 30 Hz."""


@dataclass(frozen=True)
class LikelihoodCheckParameters:
    """The poses by which the likelihood is tested in real frames with true ones."""

    seed: int = 0
    """Seed of the poses."""
    start_m: float = 0.03
    """Distance in metres of a start from the true pose, in a random direction."""
    start_rad: float = float(np.deg2rad(10.0))
    """Angle in radians of a start from the true pose, about a random axis."""
    starts: int = 20
    """Number of starts in each frame."""
    scatter_m: float = 0.05
    """Root mean square in metres of the poses among which the true one is ranked."""
    scatter_rad: float = float(np.deg2rad(20.0))
    """Root mean square in radians of the poses among which the true one is ranked."""
    scattered: int = 10_000
    """Number of poses among which the true one is ranked."""
    object_rate: float = 0.3
    """Share of the newest frame in the learned colours of the object."""
    around_rate: float = 0.5
    """Share of the newest frame in the learned colours of its surroundings."""
    drawn: int = 1000
    """Number of poses that are tried about an object's last one."""
    refined: int = 5
    """Number of these, the likeliest ones, that are refined."""


@dataclass(frozen=True)
class TrackerSpeedParameters:
    """The poses and frames that are weighed, and the time for it."""

    seed: int = 0
    """Seed of people and poses."""
    people: int = 2
    """Number of simulated people who are learned from; the next one is shown."""
    learned_frames: int = 120
    """Number of frames of each of them."""
    shown_frame: int = 60
    """The frame in which poses are weighed."""
    hypotheses: int = 1000
    """Number of poses that are weighed at once for the rates."""
    naive_hypotheses: int = 100
    """Number of poses that NumPy weighs one by one for the reference."""
    seconds: float = 6.0
    """Seconds for which rates are measured, and again for frames in which poses are weighed."""
    thread_counts: tuple[int, ...] = (1, 2)
    """Numbers of threads in which hypotheses are weighed, as far as there are cores."""
    hypothesis_counts: tuple[int, ...] = (100, 1_000, 10_000)
    """Numbers of hypotheses that are weighed in a frame."""
    region_margin_pixels: float = 60.0
    """Margin in pixels around the poses of the part of a frame that is prepared."""


@dataclass(frozen=True)
class TrainingCostParameters:
    """On how many labelled frames training is timed, and how it is asked afterwards."""

    seed: int = 20
    """Seed of the simulated people."""
    sizes: tuple[int, ...] = (10_000, 100_000, 1_000_000)
    """Numbers of labelled frames."""
    frames: int = 360
    """Number of frames of a recording: the paper's."""
    performances: int = 6
    """Number of recordings of each person."""
    stranger: int = 1_000_000
    """The number of the person whose body poses are asked for: beyond all that are learned from."""
    linear_searches: int = 50
    """Number of body poses, at the least, that are looked for linearly as the reference."""
    equal_distance: float = 1e-5
    """Relative difference up to which the search found the same distance as the reference."""


@dataclass(frozen=True)
class TransportParameters:
    """The frames that go from one process to another."""

    seed: int = 0
    """Seed of the simulated person in the frame."""
    shown_frame: int = 60
    """Which frame of the simulation is sent, again and again."""
    pairs: int = 6
    """Number of pairs of processes that frames go between."""
    frames: int = 150
    """Number of frames by each way, in each pair."""
    first_frames: int = 30
    """Number of frames at the beginning that do not count: links are opened then."""
    frame_rate: float = 30.0
    """Frames a second by each way."""


@dataclass(frozen=True)
class HubCostParameters:
    """The rigs that a hub is measured with, and what they publish."""

    transport: TransportParameters = TransportParameters()
    """The frame that is sent, and how often."""
    rig_counts: tuple[int, ...] = (1, 4, 16)
    """Numbers of rigs on one hub."""
    tracking_s: float = 0.01
    """Seconds after its frame at which a pose is published: what a tracker takes."""
    preview_rate: float = 5.0
    """Previews a second of each camera."""
    preview_bytes: int = 8_000
    """Bytes of a preview: what capture's have."""
    warming_s: float = 4.0
    """Seconds at the beginning that do not count: links fill then."""
    measured_s: float = 20.0
    """Seconds that count: twice as long as a link outlasts a reader that stands still."""
    stuck_rigs: int = 4
    """Number of rigs on the hub while a reader of the first one stands still."""
    pairs: int = 4
    """Number of pairs of processes between which the hub is compared with a plain router."""


@dataclass(frozen=True)
class RecorderCostParameters:
    """What writers are handed, and which rigs recorders are measured with."""

    written_frames: int = 900
    """Frames that each writer is handed in a turn, with their skeletons and poses: half a minute
    of a rig."""
    turns: int = 6
    """Number of times that each writer writes them."""
    rig_counts: tuple[int, ...] = (1, 4)
    """Numbers of rigs, each with a recorder."""
    warming_s: float = 4.0
    """Seconds at the beginning in which no processor time counts."""
    measured_s: float = 30.0
    """Seconds in which it does."""


DEFAULT_COMPARISON = ComparisonParameters()
DEFAULT_FRAME_COST = FrameCostParameters()
DEFAULT_FUSION_COST = FusionCostParameters()
DEFAULT_HUB_COST = HubCostParameters()
DEFAULT_LIKELIHOOD_CHECK = LikelihoodCheckParameters()
DEFAULT_RECORDER_COST = RecorderCostParameters()
DEFAULT_TRACKER_SPEED = TrackerSpeedParameters()
DEFAULT_TRAINING_COST = TrainingCostParameters()
DEFAULT_TRANSPORT = TransportParameters()


@dataclass(frozen=True)
class SkeletonCheckParameters:
    """On whom skeletons from images are checked."""

    seed: int = 16
    """Seed of the simulated people."""
    people: int = 2
    """Number of simulated people, each of whom does everything."""
    frames: int = 90
    """Number of frames of each recording: 3 s at 30 Hz, from the second second on."""
    first_frame: int = 30
    """Frame that each recording begins at: most of a performance's first second is standing."""
    in_place_m: float = 0.5
    """Distance from a person's HipCenter within which somebody found is that person, metres."""
    real_step: int = 3
    """Every so many-th frame of a real recording is lifted."""
    timed_frames: int = 90
    """Number of frames that are timed at each size."""
    untimed_frames: int = 10
    """Number of frames before them that are not: what is compiled is loaded then."""


DEFAULT_SKELETON_CHECK = SkeletonCheckParameters()


@dataclass(frozen=True)
class ObjectAccuracyParameters:
    """In which scenes new objects are compared with the true ones."""

    seed: int = 17
    """Seed of the cameras and of where things stand."""
    scenes: int = 8
    """Number of scenes of each object, each with another camera, place and turn."""
    frames: int = 15
    """Number of frames of depth of each scene."""
    distance_m: tuple[float, float] = (0.65, 1.1)
    """Least and largest distance in metres of the camera from the middle of the table."""
    down: tuple[float, float] = (0.45, 0.9)
    """Least and largest angle in radians at which it looks down."""
    aside: float = 0.5
    """Angle in radians by which it stands to a side, at the most."""
    off_middle_m: float = 0.12
    """Distance in metres from the middle of the table along x and along y, at the most."""
    samples: int = 60_000
    """Number of points on a surface by which its nearest triangles are found."""
    neighbours: int = 8
    """Number of nearest points whose triangles are tried."""
    compared: int = 4000
    """Number of points of each surface whose distance from the other is measured."""


DEFAULT_OBJECT_ACCURACY = ObjectAccuracyParameters()


@dataclass(frozen=True)
class LabelCheckParameters:
    """From which keyframes labels are made, and on whom they are measured."""

    seed: int = 0
    """Seed of a person's inaccuracy."""
    people: int = 2
    """Number of the dataset's people, the first ones, whose recordings are labelled."""
    every: int = 30
    """Frames from one keyframe to the next: a second."""
    spacings: tuple[int, ...] = (60, 30, 15, 10)
    """Frames from one keyframe to the next that are tried to find how many are needed, the most
    first."""
    visible_aim_mm: float = 5.0
    """Greatest median error where the object is visible that is good enough, in mm."""
    visible_aim_deg: float = 2.0
    """Greatest median error of its turn there, in degrees."""
    hidden_aim_mm: float = 10.0
    """Greatest median error where it is not visible, in mm."""
    hidden_aim_deg: float = 4.0
    """Greatest median error of its turn there, in degrees."""
    keyframe_m: float = 0.005
    """Metres by which each keyframe is off, in a random direction."""
    keyframe_rad: float = float(np.deg2rad(3.0))
    """Radians by which each is turned, about a random axis."""
    visible_share: float = 1.0 / 3.0
    """Share of the object from which on it counts as visible."""


DEFAULT_LABEL_CHECK = LabelCheckParameters()


@dataclass(frozen=True)
class LikelihoodBiasParameters:
    """At which poses objects are rendered, and how far about them the optimum is looked for."""

    seed: int = 19
    """Seed of rooms, poses and starts."""
    rooms: int = 3
    """Number of rooms, in turns."""
    camera_m: float = 3.9
    """Distance in metres of the camera from the middle of the room, to which people stand; the back
    wall is 1.1 to 1.8 m farther away."""
    camera_height_m: float = 1.3
    """Height of the camera in metres."""
    finer: int = 5
    """Number of samples, each way, that a pixel's colour is the mean of; odd, so that one is in its
    middle."""
    learned: int = 24
    """Number of frames that an object's appearance is learned from."""
    poses: int = 60
    """Number of frames in which it is looked for."""
    distance_m: tuple[float, float] = (1.5, 4.0)
    """Least and largest distance in metres of the object's middle."""
    margin: float = 0.25
    """Share of the image, on each side, in which no object's middle is."""
    object_rate: float = 0.1
    """Share of a frame in the object's colours: what trackers learn."""
    around_rate: float = 0.5
    """Share of a frame in the surroundings' colours."""
    across_m: float = 0.015
    """Metres to each side, across the ray, within which the optimum is looked for."""
    along_m: float = 0.2
    """Metres along the ray, either way, within which it is looked for."""
    offsets: int = 81
    """Number of places, each way, at which poses are weighed."""
    beside_peak: int = 8
    """Number of these on either side of the best one to which a parabola is fitted."""
    starts: int = 4
    """Number of starts of refinement in each frame."""
    start_m: float = 0.02
    """Distance in metres of a start from the truth, in a random direction."""
    free_m: float = 1.0
    """Standard deviation in metres of the prior on a start's place, which says next to nothing."""
    turn_rad: float = 1e-3
    """Standard deviation in radians of the prior that holds a start's turn, which is true."""
    refinements: int = 3
    """Number of times that a start is refined, each time about where the last one ended."""


DEFAULT_LIKELIHOOD_BIAS = LikelihoodBiasParameters()


@dataclass(frozen=True)
class PeopleCalibrationCheckParameters:
    """Which rigs are calibrated from people, and what they must reach."""

    seeds: tuple[int, ...] = tuple(range(900, 910))
    """Seeds of people, walks and cameras: nothing was chosen on them."""
    seconds: float = 60.0
    """Time for which somebody walks about."""
    around_deg: tuple[tuple[float, float], ...] = ((-15.0, 15.0), (60.0, 120.0), (-150.0, -60.0))
    """Least and largest angle of each camera about the room's middle."""
    distance_m: tuple[float, float] = (3.2, 4.2)
    """Least and largest distance of cameras from it."""
    height_m: tuple[float, float] = (0.8, 2.2)
    """Least and largest height of cameras."""
    offset_s: float = 2.0
    """Time by which a camera's clock is off from the first's, at the most."""
    drift_ppm: float = 50.0
    """Microseconds by which it is off more every second, at the most."""
    dropped_share: float = 0.02
    """Share of frames that are lost."""
    frame_rates: tuple[float, ...] = (30.0, 30.0, 30.0)
    """Rate of each camera, Hz."""
    aim_mm: float = 15.0
    """Error of a camera's place relative to the first camera that is good enough."""
    aim_deg: float = 0.5
    """Error of its rotation."""
    aim_ms: float = 5.0
    """Error of its clock's offset."""


DEFAULT_PEOPLE_CALIBRATION_CHECK = PeopleCalibrationCheckParameters()


@dataclass(frozen=True)
class RigCheckParameters:
    """How much is simulated where a rig's cameras are compared with each of them alone."""

    interactions: tuple[str, ...] = (
        "drinkFromMug",
        "answerPhone",
        "liftWeights",
        "hitTennisBall",
        "putOnGlasses",
        "sweepFloor",
    )
    """What people do; all of it can be done while walking about."""
    frames: int = 360
    """Number of frames that are tracked: a whole performance."""
    people: int = 4
    """Number of people who are learned from."""
    learned_frames: int = 150
    """Number of frames of each of them."""
    looks: int = 60
    """Number of frames, about, that an object's colours are learned from."""


DEFAULT_RIGS = RigCheckParameters()
