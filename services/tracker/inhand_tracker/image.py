"""What the camera sees of one frame, prepared once for however many objects are tracked in it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from inhand_tracker.camera import Intrinsics
from inhand_tracker.depths import MeasuredSurfaces
from inhand_tracker.edges import chamfer_image


@dataclass(frozen=True)
class Image:
    """A luminance image (H, W), or None, and the camera that took it.

    ``depth`` (h, w) is what was measured in the same view, in metres, 0 where nothing was;
    ``colour`` (H, W, 3) is RGB.
    """

    grey: NDArray[np.uint8] | None
    camera: Intrinsics
    depth: NDArray[np.float32] | None = None
    colour: NDArray[np.uint8] | None = None

    @cached_property
    def chamfer(self) -> NDArray[np.float32] | None:
        """How near each pixel (H, W) is to an edge."""
        return None if self.grey is None else chamfer_image(self.grey)

    @cached_property
    def surfaces(self) -> MeasuredSurfaces | None:
        """The surfaces that the depth image shows."""
        if self.depth is None:
            return None
        height, width = self.depth.shape
        return MeasuredSurfaces(self.depth, self.camera.scaled_to(width, height))
