"""What stands behind people in the depth of a camera, and what is new before it."""

from collections.abc import Iterable
from dataclasses import dataclass

import cv2
import numpy as np
from inhand_capture.view.masks import Mask
from inhand_schemas.messages import CameraInfo
from numpy.typing import NDArray

from inhand.redaction.parameters import DEFAULT_REDACTION, RedactionParameters

Metres = NDArray[np.float32]
Units = NDArray[np.uint16]


@dataclass(frozen=True)
class Background:
    """Distances (H, W) in metres of what stands behind people: 0 where nothing was measured, and
    NaN where it was never seen without people before it."""

    distances: Metres


def background_of(
    samples: Iterable[tuple[Units, Mask]],
    depth_scale: float,
    parameters: RedactionParameters = DEFAULT_REDACTION,
) -> Background | None:
    """Find the background of depth pictures (H, W) in units of so many metres, of which each has a
    mask of where people may be; None where there is none, or they are not of one size."""
    taken = list(samples)
    if not taken or len({depth.shape for depth, _ in taken}) > 1:
        return None
    free = np.stack([~mask for _, mask in taken])
    depths = np.sort(np.where(free, np.stack([depth for depth, _ in taken]), np.uint16(0)), axis=0)
    seen, measured = free.sum(axis=0), (depths > 0).sum(axis=0)
    # Those that were measured stand last; a share of them lies before the background.
    place = len(taken) - 1 - ((1.0 - parameters.behind) * measured).astype(int)
    distances = np.take_along_axis(depths, np.minimum(place, len(taken) - 1)[None], axis=0)[0]
    distances = distances * np.float32(depth_scale)
    distances[measured < parameters.measured * seen] = 0.0
    distances[seen == 0] = np.nan
    return Background(distances.astype(np.float32))


def new_things(
    depth: Metres,
    background: Background | None,
    parameters: RedactionParameters = DEFAULT_REDACTION,
) -> Mask:
    """Return the pixels (H, W) in which something is, or may be, before the background.

    That is all of them where it is not known. What is smaller than speckles is left out.
    """
    if background is None or background.distances.shape != depth.shape:
        return np.ones(depth.shape, bool)
    behind = background.distances
    margin = parameters.margin_m + parameters.margin_per_m2 * behind**2
    nearer = np.where(behind > 0.0, depth < behind - margin, depth > 0.0)
    new = (nearer | np.isnan(behind)).astype(np.uint8)
    kernel = np.ones((parameters.speckle, parameters.speckle), np.uint8)
    opened: NDArray[np.uint8] = np.asarray(cv2.morphologyEx(new, cv2.MORPH_OPEN, kernel), np.uint8)
    return opened.astype(bool)


def separate_things(
    new: Mask,
    depth: Metres,
    background: Background | None,
    info: CameraInfo,
    parameters: RedactionParameters = DEFAULT_REDACTION,
) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
    """Number the connected things of a mask (H, W) from 1 on, 0 elsewhere, and measure the square
    metres (N + 1,) of each."""
    count, labels = cv2.connectedComponents(new.astype(np.uint8), connectivity=8)
    numbers = np.asarray(labels, np.int32)
    distances = np.where(depth > 0.0, depth, parameters.unmeasured_m)
    if background is not None and background.distances.shape == depth.shape:
        known = (depth <= 0.0) & (background.distances > 0.0)
        distances = np.where(known, background.distances, distances)
    height, width = depth.shape
    pixel = (info.width / width) * (info.height / height) / (info.fx * info.fy)
    areas = np.zeros(count)
    np.add.at(areas, numbers, pixel * distances**2)
    areas[0] = 0.0
    return numbers, areas
