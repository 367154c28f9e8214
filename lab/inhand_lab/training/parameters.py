"""Every number of training that can be tuned.

`inhand train` uses them all. What those of a recogniser are worth together shows `inhand recognise
DATASET`; what those of movements and of the support vector machine are, `inhand recognise DATASET
--alone`. Where nothing else is said a number was set by hand with these figures in view.
"""

from dataclasses import dataclass

from inhand_lab.world.idle_people import Idleness


@dataclass(frozen=True)
class TrainingParameters:
    """Which recordings are refused, how many frames are learned from, and how."""

    # Which recordings are refused (recording_checks); docs/training.md lists these limits.
    most_missing_share: float = 0.5
    """Share of a recording's frames that may lack a label, or a whole body, at the most."""
    absent_share: float = 0.95
    """Share of the frames that show somebody from which a joint that they lack is never seen, and
    has a stand-in: no body tracker loses a joint that is in view for as long."""
    clear_hand_share: float = 0.9
    """Share of frames in which an object is nearer to one hand from which it is that hand's."""
    clear_hand_ratio: float = 0.5
    """Distance of an object from the nearer hand, in those from the other one, below which it is at
    that hand; a box in both hands is as far from each."""
    fewest_clear_share: float = 0.25
    """Share of frames in which it must be at one hand for the hand to say anything."""
    fewest_compared: int = 3
    """Number of recordings from which on one can be unlike all others."""
    compared_frames: int = 500
    """Number of frames, evenly spaced, at the least, by which rotations in them are compared."""
    clear_rotation_gain: float = 0.2
    """Gain in the mean squared cosine of half the angle to other recordings' rotations from which
    a recording may be written in another way: of the simulator's objects it is 0.23 or more where
    one recording is, and 0.01 or less where none is."""
    same_rotation_share: float = 0.92
    """That cosine as a share of what the other recordings have among each other, from which a
    recording is like them: it is 0.93 or more where one is written in another way. It seldom is
    where somebody only grips an object the other way round."""
    moved_m_per_s: float = 0.1
    """Speed in metres a second above which an object is moved, so somebody holds it."""
    fewest_moved: int = 30
    """Number of frames of a moved object from which on it is judged how it is held."""
    steady_hold_m: float = 0.015
    """Spread in metres of a hand's places on the object within which nothing is wrong: by true
    joints of who films it is 0.005 to 0.012 in either reading, as the camera is hardly turned."""
    clear_hold_ratio: float = 1.25
    """Spread of a hand's places on the object as rotations are read, in that if they are read in
    another way, from which all of an object's recordings are written in that way. The median of
    right ones is 0.93 or less for the simulator's objects, and 0.3 or less for measured ones; of
    misread ones it is more than this for eleven of these fifteen, and 2.3 or more for measured
    ones."""

    # Which meshes and marks are refused (shape_checks).
    smallest_m: float = 0.005
    """Size in metres of the smallest object: nothing smaller is tracked in a hand."""
    largest_m: float = 4.0
    """Size in metres of the largest object: more than a javelin or an oar, and less than a mug
    whose inches, centimetres or millimetres were taken for metres."""
    least_mark_spread_m: float = 0.001
    """Root mean square distance in metres of marks from the line through them, at the least:
    labels are no more exact."""
    beyond_mesh_share: float = 0.02
    """How far a mark may lie outside the box around the mesh, in sizes of the object, wherever the
    surface is."""
    farthest_mark_m: float = 0.015
    """Distance in metres of a mark outside that box from the surface, at the most: measured
    markers stand out by no more."""
    farthest_mark_share: float = 0.12
    """That distance in sizes of the object, where that is more: of the simulator's objects a
    quarter turn moves all marks but those of symmetric ones by more."""
    least_marked_share: float = 0.04
    """Size of the box around the marks in sizes of the object, at the least: inches for metres
    give 0.025."""

    clear_unit_share: float = 0.2
    """Size of marks in another unit, in sizes of the object, from which that unit is proposed."""

    # From how much the appearance of an object is learned (appearance_samples).
    appearance_recordings: int = 12
    """Number of recordings, evenly spaced, at the most: an object looks much the same in all."""
    appearance_frames: int = 60
    """Number of frames of all these recordings together, evenly spaced, at the most."""

    # From how much a recogniser is learned (recogniser_training, recorded_movements).
    usual_pose_step: int = 10
    """Number of frames from one whole body to the next that fills in what is not seen of others."""
    body_step: int = 4
    """Number of frames from one body that is learned from to the next: successive ones are much
    the same."""
    least_bodies: int = 37
    """Number of bodies that are learned from, at the least, of a recording that has as many: of a
    short one successive ones too, as a mimed swing takes half a second."""
    kept_poses: int = 1000
    """Number of body poses, about, that a recogniser keeps to fill in what is not seen."""
    idle_kinds: tuple[Idleness, ...] = ("fidget", "stand", "walkOnSpot", "walkAbout")
    """Kinds of simulated people who use nothing, of whom every recogniser learns."""
    idle_people: int = 16
    """Number of them, of each kind."""
    idle_seed: int = 7
    """Seed of these people; others than those on whom false objects are counted."""
    idle_step: int = 6
    """Number of frames from one body of theirs that is learned from to the next."""

    # How movements are learned (movement_training).
    action_gaussians: int = 3
    """Number of Gaussians of an action."""
    idle_gaussians: int = 60
    """Number of Gaussians of people who use nothing, who may do anything."""
    within_limits_share: float = 0.98
    """Share of the frames of people left out that are within the limits of all movements."""
    within_reach_share: float = 0.3
    """Share of the frames of people left out that are within the reach of their own action."""
    shrinkage: float = 0.05
    """Share of the identity in the covariance of standardised features."""
    courses: int = 24
    """Number of recordings of an action, at the most, whose arms' courses a recogniser keeps, of as
    many people as there are: cost grows with it."""
    hanging_reach: float = 0.35
    """Distance in lengths of an arm from where wrists usually hang within which both hang; nothing
    is kept of how a recording begins and ends so."""
    groups: int = 5
    """Number of groups of participants, at the most, each of which is left out once."""
    prior_frames: float = 1.0
    """Number of frames of every class that a Gaussian is taken to have beforehand."""
    tempers: tuple[float, ...] = (0.01, 0.02, 0.05, 0.1, 0.2, 0.4)
    """Shares of each frame's evidence that are new, of which training chooses the best one."""

    # How body poses are learned (svm_training).
    svm_poses: int = 5000
    """Number of body poses, evenly spaced, at the most: time grows with its square."""
    svm_cost: float = 1.0
    """Cost C of a body pose on the wrong side; LIBSVM's default."""
    svm_folds: int = 5
    """Number of folds of the cross-validation that gives probabilities; LIBSVM's."""
    svm_seed: int = 0
    """Seed of the draw of these folds."""
    sigmoid_steps: int = 100
    """Number of Newton steps, at the most, to a sigmoid (Lin, Lin and Weng 2007)."""

    # How it is learned what a tracker's support is worth (presence_training).
    looks_at: tuple[float, ...] = (0.02, 0.35, 0.7)
    """Shares of a recording after which every object is looked for: at first most lie untouched."""
    look_frames: int = 2
    """Number of successive frames of a look: the second one finds more."""
    prior_looks: float = 4.0
    """Number of looks that are taken to have had the usual support beforehand."""
    prior_part_looks: float = 15.0
    """Number of looks that are taken to have had the usual spreads of its parts beforehand."""
    least_support_spread: float = 3.0
    """Standard deviation of an object's support at the least, as a log-likelihood ratio."""


DEFAULT_TRAINING = TrainingParameters()
