"""Where the simulator's noise is set: the sensors' and the skeleton tracker's.

``DEFAULT_NOISE`` holds them all. Figures of the sensors are the makers' and of measurements that
stereo.py and structured_light.py cite; those of skeletons were fitted so that simulated people
resemble recorded ones (`inhand simulate --realism` prints both side by side), and none was chosen
for what a method makes of it. Records that compiled code reads are named tuples.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from inhand_lab.sensing.skeleton_noise_parameters import SkeletonNoise


@dataclass(frozen=True)
class ColourNoise:
    """How a colour camera's levels, 0 to 255, differ from the scene's.

    How the sizes were chosen is not recorded; tests/lab/sensing/test_sensor.py bounds them.
    """

    read_noise: float = 1.6
    """Deviation of a black pixel, levels."""
    shot_noise: float = 0.16
    """Variance that each level of brightness adds, squared levels."""
    exposure_drift: float = 0.05
    """Deviation of the logarithm of brightness, as exposure and daylight change."""
    exposure_period: float = 5.0
    """Seconds in which brightness and white balance drift."""
    balance_drift: float = 0.012
    """Deviation of the logarithm of each colour's brightness, as the white balance changes."""
    flicker: float = 0.006
    """Deviation of the logarithm of brightness from frame to frame, as mains light beats with the
    exposure."""


class StructuredLightNoise(NamedTuple):
    """How a Kinect's depth errs; structured_light.py says what the figures come from."""

    baseline: float = 0.075
    """Distance between projector and infrared camera, metres."""
    focal_length: float = 580.0
    """Focal length of the infrared camera, pixels."""
    steps_per_pixel: float = 8.0
    """Steps of disparity in a pixel."""
    nearest: float = 0.5
    """Distance below which nothing is measured, metres."""
    furthest: float = 8.0
    """Distance beyond which nothing is measured, metres."""
    grain: float = 1.2
    """Pixels over which noise is correlated, as block matching makes it."""
    lateral_deviation: float = 0.8
    """Deviation of the place that a pixel's depth is taken from, pixels."""
    patch: float = 1.5
    """Size of the patches that are lost at an edge, pixels."""
    least_deviation: float = 0.0012
    """Deviation of depth where it is most exact, metres."""
    deviation_growth: float = 0.0019
    """Deviation of depth that each squared metre beyond ``most_exact`` adds, 1/m."""
    most_exact: float = 0.4
    """Distance at which depth is most exact, metres."""
    fresh: float = 0.25
    """Share of the deviation that is new in every frame; the dots' part of it stands still."""
    shadow: float = 3.0
    """Width of a projector's shadow that the matching window still bridges, pixels."""
    edge_jump: float = 0.05
    """Relative change of inverse depth between neighbours that counts as an edge."""
    edge_loss: float = 0.11
    """Share of the pixels at an edge that return nothing."""


class StereoNoise(NamedTuple):
    """How an OAK-D's depth errs; stereo.py says what the figures come from."""

    baseline: float = 0.075
    """Distance between the two grey cameras, metres."""
    focal_length: float = 882.5
    """Focal length of the grey cameras, pixels."""
    steps_per_pixel: float = 8.0
    """Steps of disparity in a pixel."""
    most_disparity: float = 95.0
    """Disparity to which is searched, pixels: what is nearer is not measured."""
    furthest: float = 12.0
    """Distance beyond which nothing is measured, metres."""
    grain: float = 2.5
    """Pixels over which noise is correlated, as the matching window makes it."""
    lateral_deviation: float = 1.6
    """Deviation of the place that a pixel's depth is taken from, pixels."""
    patch: float = 12.0
    """Size of the patches of surface without texture, pixels."""
    matching_deviation: float = 0.25
    """Deviation of disparity, pixels."""
    fresh: float = 0.6
    """Share of the deviation that is new in every frame: unlike projected dots, shot noise is."""
    edge_jump: float = 0.04
    """Relative change of inverse depth between neighbours that counts as an edge."""
    edge_loss: float = 0.5
    """Share of the pixels at an edge that the left-right check discards."""
    bare_walls: float = 0.20
    """Share of walls and floor without texture; assumed, as are clothes and things."""
    bare_clothes: float = 0.04
    """Share of a person without texture."""
    bare_things: float = 0.10
    """Share of the object without texture."""
    window: int = 15
    """Width of the matching window, pixels."""
    faint: float = 0.5
    """Mean change of brightness from pixel to pixel of a window, in levels of 256, that is enough
    to match even on a bare surface."""


@dataclass(frozen=True)
class NoiseParameters:
    """The noise of every simulated sensor."""

    colour: ColourNoise = ColourNoise()
    """The cameras' colours."""
    structured_light: StructuredLightNoise = field(default_factory=StructuredLightNoise)
    """The Kinect's depth."""
    stereo: StereoNoise = field(default_factory=StereoNoise)
    """The OAK-D's depth."""
    skeleton: SkeletonNoise = field(default_factory=SkeletonNoise)
    """The skeleton tracker's joints."""


DEFAULT_NOISE = NoiseParameters()
"""The noise of datasets of this version."""
