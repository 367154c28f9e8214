"""Every number by which recordings are read that can be tuned; docs/training.md lists them.

Where nothing is said a number was set by hand.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class DatasetParameters:
    """Decides which times, labels and units of a recording can be meant."""

    # Times (recording_times).
    fewest_timed: int = 10
    """Number of frames from which on their rate is judged."""
    fastest_hz: float = 1_000.0
    """Frames a second above which times are in another unit than nanoseconds: no tracker of bodies
    is as fast."""
    most_backwards_share: float = 0.01
    """Share of the frames that may be earlier than the one before: the clock was set."""
    farthest_out_ns: int = 1_000_000_000
    """Nanoseconds by which one frame may lie outside the times of both neighbours."""
    same_rate_share: float = 0.1
    """Difference of two frame rates, as a share, up to which they are the same: times in whole
    milliseconds differ by 1 %, and lost frames are passed over by the median."""
    usual_rate_hz: float = 30.0
    """Frames a second of a recording that shows none, as of one frame."""
    gap_s: float = 0.5
    """Time in seconds between frames beyond which it is a gap, and says nothing of the rate."""

    # Labels that jump (wild_labels, and recording_checks of training).
    fastest_m_per_s: float = 60.0
    """Speed of a label in metres a second above which it is wrong: faster than the head of a golf
    club."""
    fastest_rad_per_s: float = 85.0
    """Speed of a label's turn in radians a second above which it is wrong: faster than a golf club
    turns; a label that is upside down for one frame at 30 Hz turns faster."""
    most_wild_share: float = 0.02
    """Share of the labels, and one of a short recording, that may be wild and are left out: the
    measured clubs of five golf swings at 240 Hz have up to 1 % of them at the impact."""
    wild_run_s: float = 0.02
    """Time in seconds that labels may be wild in a row: one frame at 30 Hz, four at 240."""
    wild_bridge_s: float = 1.0 / 30.0
    """Time in seconds, at the most, for which an object may move at its fastest while labels are
    left out, so that a label that is turned over for good is not taken for a short one."""
    most_named: int = 5
    """Number of frames that a warning names."""

    # How one long recording is cut (stretches).
    shortest_stretch_s: float = 5.0
    """Seconds of labelled frames that a stretch has at the least: about a simulated interaction."""
    stretch_gap_s: float = 2.0
    """Seconds of labelled frames between two stretches that neither has: by then a body is
    elsewhere in most interactions."""
    most_stretches: int = 5
    """Number of stretches at the most; more would lose more to gaps."""

    # Units (units).
    usual_stature_m: float = 1.7
    """Height in metres of a usual person, by which a unit is named."""
    smallest_stature_m: float = 0.4
    """Height in metres of the smallest person; no child who holds things is as small."""
    tallest_stature_m: float = 4.5
    """Height in metres above which joints are in another unit: misnamed joints give 4.1 m (a motion
    archive that is imported with a warning), inches 67 and feet 5.6 m."""
    one_frame_ratio: float = 5.0
    """Length of the trunk in one frame, in those of the other frames, from which that frame is in
    another unit: wild joints of a Kinect do not reach it (UTD-MHAD)."""
    farthest_label_m: float = 4.0
    """Distance in metres of an object from the nearest joint, in the median frame, above which
    labels are in another unit: they are of what somebody holds."""
    held_label_m: float = 1.0
    """Distance in metres of an object from the nearest joint within which a unit is named."""

    # Mirror images (facing).
    backward_feet: float = -0.3
    """Mean of where feet point, in the direction of the pelvis and in lengths of the feet, in the
    median frame, below which the whole body is a mirror image. Of simulated people it is 0.56 or
    more, of UTD-MHAD, whose feet are seen badly, between 0.0 and 0.72."""


DEFAULT_DATASET = DatasetParameters()
