"""Every number of the comparison of simulated sensors with real ones that can be tuned.

`inhand simulate --realism` shows the properties that they define, and which of them are within the
limit.
"""

from dataclasses import dataclass
from typing import NamedTuple


class Pace(NamedTuple):
    """A range of a joint's speed, metres a second, and its name."""

    name: str
    lowest: float
    highest: float


@dataclass(frozen=True)
class RealismParameters:
    """What is compared, at what paces, and when a property is near enough."""

    # When a property is judged, and near enough (sensor_comparison).
    within: float = 1.5
    """Factor by which a simulated property may differ from the real one, at the most."""
    resamples: int = 200
    """Number of draws of the real people, with replacement."""
    confidence: float = 0.95
    """Share of these draws that an interval holds."""
    seed: int = 0
    """Seed of these draws."""

    # How postures are compared (posture_angles, posture_comparison).
    usual_share: float = 0.8
    """Share of frames in the usual range of an angle: from the first decile to the ninth."""
    least_covered: float = 0.5
    """Share of real frames within the usual range of simulated ones below which an angle is marked:
    it would be ``usual_share`` if both were alike."""

    # Who is measured (measured_people).
    participants: int = 8
    """Number of simulated people: as many as real ones were recorded."""
    mimed: tuple[str, ...] = ("armCurl", "knock", "drawX")
    """Real interactions of arms while the body stands, in which joints come back."""
    worked: tuple[str, ...] = ("liftWeights", "hammerNail", "drinkFromMug")
    """Simulated interactions of that kind."""
    depth_step: int = 6
    """Number of frames from one real depth image that is measured to the next."""
    first_depth_frame: int = 2
    """Number of the first real depth image that is measured."""
    simulated_depth_frames: tuple[int, ...] = tuple(range(24, 355, 30))
    """Simulated frames whose depth is measured: about as many of each person as real ones."""
    simulated_depth_step: int = 4
    """Number of interactions of a simulated person of which one's depth is measured."""
    cut_out_mm: int = 150
    """Distance in millimetres behind a simulated person beyond which depth is cut out."""
    cut_out_pixels: int = 3
    """Width in pixels of the rim around a simulated person that is not cut out."""

    # How skeletons are measured (skeleton_properties), at 30 Hz.
    speed_reach: int = 3
    """Number of frames before and after, between which a joint's speed is taken."""
    window: int = 45
    """Number of frames over which the deviation of a bone's length is taken."""
    drift_lag: int = 8
    """Number of frames between which a slow drift is measured."""
    paces: tuple[Pace, ...] = (
        Pace("still", 0.0, 0.05),
        Pace("slow", 0.05, 0.3),
        Pace("brisk", 0.3, 1.0),
        Pace("fast", 1.0, 2.5),
    )
    """Ranges of a joint's speed that are measured apart: errors grow with it."""
    ways_m: tuple[tuple[float, float], ...] = ((0.0, 0.2), (0.2, 1.0), (1.0, 4.0))
    """Ranges of the way in metres, that a joint goes in ``window`` frames, that are measured
    apart."""
    forearm_off_share: float = 0.3
    """Share of its usual length by which a forearm differs from where its wrist has left it."""
    hand_off_share: float = 0.5
    """Share of its usual length by which a hand's bone differs from where it has left the wrist."""
    turned_deg: float = 90.0
    """Angle in degrees between forearm and hand from which the hand counts as turned."""

    # How depth is measured (depth_properties), in images 320 pixels wide.
    patch_pixels: int = 6
    """Half the width in pixels of the patch on the chest."""
    resting_m: float = 0.002
    """Distance in metres that a chest at rest moves between two frames, at the most."""
    smoothed_pixels: int = 5
    """Width in pixels of the median that an outline is ragged against."""
    reaching_m: float = 0.15
    """Distance in metres in front of the shoulders from which a hand is before the trunk."""
    least_trunk_pixels: int = 25
    """Height in pixels of a trunk that is upright, at the least."""
    least_hips_pixels: int = 10
    """Width in pixels of hips that face the camera, at the least."""
    level_range_mm: tuple[float, float] = (2000.0, 3400.0)
    """Range of distances in millimetres whose steps are measured: where the real people stand."""
    middle_level_mm: float = 2700.0
    """Distance in millimetres that parts near steps from far ones."""

    # How nearly poses come back (repeatability).
    again_s: float = 1.5
    """Seconds after which the same pose within one recording is a return."""
    others: int = 5
    """Number of other people, at the most, among whom the nearest pose is looked for."""


DEFAULT_REALISM = RealismParameters()
