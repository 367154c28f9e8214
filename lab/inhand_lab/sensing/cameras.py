"""The cameras by which a simulated scene can be seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from inhand_tracker.geometry.camera import Intrinsics


@dataclass(frozen=True)
class Camera:
    """A camera of colour and depth."""

    name: str
    intrinsics: Intrinsics
    depth_from: Literal["structured light", "stereo"]
    exposure: float
    """Time for which the shutter of a colour frame is open, seconds."""
    frame_rate: float = 30.0
    """Frames a second."""


KINECT = Camera(
    "kinect", Intrinsics(525.0, 525.0, 319.5, 239.5, 640, 480), "structured light", exposure=0.020
)
"""Kinect for Xbox 360 at 640 x 480, in the light of a living room."""

OAK_D = Camera(
    "oak_d", Intrinsics(1000.0, 1000.0, 639.5, 359.5, 1280, 720), "stereo", exposure=0.015
)
"""Luxonis OAK-D with depth aligned to colour at 1280 x 720.

The sheet gives the colour sensor a field of view of 69 degrees over all its 4056 columns; video
uses the middle 3840 of them, a third as many pixels, and so a focal length of about 1000.
"""

CAMERAS = {camera.name: camera for camera in (KINECT, OAK_D)}
"""The cameras by name."""
