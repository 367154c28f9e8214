"""What one part of a frame shows, prepared for the objects that are looked for in it."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import cv2
import numpy as np

from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.sight.colours import Bins, colour_bins, without_noise
from inhand_tracker.sight.light import scale_colours
from inhand_tracker.sight.oriented_edges import edge_distances, edge_scores
from inhand_tracker.sight.parameters import DEFAULT_SIGHT, SightParameters

Region = tuple[float, float, float, float]
"""Left, top, right and bottom in pixels."""

SMALLEST_PIXELS = 16
"""Width and height of the smallest part of an image, so that filters have pixels to work on."""


@dataclass(frozen=True)
class SightFrame:
    """A part of an image: ``colour`` (H, W, 3) and ``depth`` (H, W) in metres, 0 where nothing was
    measured, or None; ``camera`` is that of the part. It is read as ``parameters`` say."""

    camera: Intrinsics
    colour: Bytes | None
    depth: Singles | None
    parameters: SightParameters = DEFAULT_SIGHT

    @cached_property
    def _smooth(self) -> Bytes | None:
        """The colours (H, W, 3) with less noise, or None."""
        return None if self.colour is None else without_noise(self.colour)

    @cached_property
    def bins(self) -> Bins | None:
        """The colours' bins (H, W), or None."""
        return None if self._smooth is None else colour_bins(self._smooth)

    @cached_property
    def edges(self) -> Bytes | None:
        """Distances (4, H, W) to oriented edges, or None without colour."""
        if self._smooth is None:
            return None
        grey = np.asarray(cv2.cvtColor(self._smooth, cv2.COLOR_RGB2GRAY), np.uint8)
        return edge_distances(grey, self.parameters)

    @cached_property
    def edge_scores(self) -> Singles | None:
        """Scores (4, 8) of those distances, or None without colour."""
        return None if self.edges is None else edge_scores(self.edges, self.parameters)


def prepare(
    image: Image,
    region: Region | None = None,
    parameters: SightParameters = DEFAULT_SIGHT,
    most_pixels: float = math.inf,
    gains: Array | None = None,
) -> SightFrame:
    """Cut the part within a region out of an image, or take all of it.

    Depth of another size is brought to that of the colours. Of a part of more than ``most_pixels``
    several pixels become one. Colours are multiplied by ``gains`` (3,), as ``LightWatch`` finds
    them. Edges and bins are found when they are first asked for.
    """
    camera, colour, depth = image.camera, image.colour, image.depth
    given = colour if colour is not None else depth
    size = (camera.width, camera.height) if given is None else given.shape[1::-1]
    if size != (camera.width, camera.height):
        camera = camera.scaled_to(*size)
    if depth is not None and depth.shape[::-1] != size:
        depth = np.asarray(cv2.resize(depth, size, interpolation=cv2.INTER_NEAREST), np.float32)
    if region is not None:
        camera, pixels = cut(camera, region)
        colour = None if colour is None else colour[pixels]
        depth = None if depth is None else depth[pixels]
    step = math.ceil(math.sqrt(camera.width * camera.height / most_pixels))
    if step > 1:
        camera, colour, depth = _smaller(camera, colour, depth, step)
    if colour is not None and gains is not None:
        colour = scale_colours(colour, gains)
    return SightFrame(
        camera,
        None if colour is None else np.ascontiguousarray(colour),
        None if depth is None else np.ascontiguousarray(depth, np.float32),
        parameters,
    )


def _smaller(
    camera: Intrinsics, colour: Bytes | None, depth: Singles | None, step: int
) -> tuple[Intrinsics, Bytes | None, Singles | None]:
    """Make one pixel of ``step`` × ``step``: their mean colour, and a depth that was measured."""
    width, height = camera.width // step, camera.height // step
    used = slice(0, height * step), slice(0, width * step)
    if colour is not None:
        size = (width, height)
        colour = np.asarray(cv2.resize(colour[used], size, interpolation=cv2.INTER_AREA), np.uint8)
    if depth is not None:
        depth = depth[used][step // 2 :: step, step // 2 :: step]
    camera = replace(camera, width=width * step, height=height * step)
    return camera.scaled_to(width, height), colour, depth


def cut(camera: Intrinsics, region: Region) -> tuple[Intrinsics, tuple[slice, slice]]:
    """Give the camera of the part of an image within a region, and that part's rows and columns."""
    left, top, right, bottom = _whole_pixels(region, camera)
    width, height = right - left, bottom - top
    part = replace(camera, cx=camera.cx - left, cy=camera.cy - top, width=width, height=height)
    return part, (slice(top, bottom), slice(left, right))


def _whole_pixels(region: Region, camera: Intrinsics) -> tuple[int, int, int, int]:
    """Round a region to pixels of the image, SMALLEST_PIXELS or more each way."""
    left, right = _whole(region[0], region[2], camera.width)
    top, bottom = _whole(region[1], region[3], camera.height)
    return left, top, right, bottom


def _whole(low: float, high: float, size: int) -> tuple[int, int]:
    smallest = min(SMALLEST_PIXELS, size)
    first = math.floor(min(max(low, 0.0), size - smallest))
    return first, math.ceil(min(max(high, first + smallest), size))
