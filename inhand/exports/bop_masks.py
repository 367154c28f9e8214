"""Which pixels show an object, and which of them nothing hides, as the BOP toolkit counts them."""

from dataclasses import dataclass, replace

import numpy as np
from inhand_schemas.messages import Pose
from inhand_tracker.geometry.camera import Intrinsics
from numpy.typing import NDArray

from inhand.exports.placed_objects import Mesh, draw_placed

_MARGIN = 1
"""Widths of the image, on each side, within which the silhouette beyond its borders counts."""
HIDDEN_M = 0.015
"""Metres by which a measured surface must be nearer than the object to hide it: the toolkit's."""

Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class ObjectMasks:
    """Pixels (H, W) of an object's silhouette and of its visible part; the number of the whole
    silhouette's pixels, beyond the image's borders too, and its bounding box (left, top, width,
    height), as the toolkit measures it from first to last pixel."""

    silhouette: Flags
    visible: Flags
    whole_pixels: int
    whole_box: tuple[int, int, int, int]

    @property
    def visible_box(self) -> tuple[int, int, int, int]:
        """The bounding box of the visible part; -1 four times where there is none."""
        return _box(self.visible)


def mask_object(
    mesh: Mesh, pose: Pose, lens: Intrinsics, depth_m: NDArray[np.float32] | None
) -> ObjectMasks:
    """Draw an object at camera_from_object, and compare its distances with measured ones.

    ``depth_m`` (H, W) is 0 where nothing was measured: there the object counts as visible, as it
    does everywhere without depth.
    """
    width, height = lens.width, lens.height
    wide = replace(
        lens,
        cx=lens.cx + _MARGIN * width,
        cy=lens.cy + _MARGIN * height,
        width=(1 + 2 * _MARGIN) * width,
        height=(1 + 2 * _MARGIN) * height,
    )
    inverse = draw_placed(mesh, pose, wide).inverse_depth
    whole = inverse > 0.0
    left, top, box_width, box_height = _box(whole)
    inside = inverse[
        _MARGIN * height : (1 + _MARGIN) * height, _MARGIN * width : (1 + _MARGIN) * width
    ]
    silhouette = inside > 0.0
    visible = silhouette.copy()
    if depth_m is not None:
        drawn_m = 1.0 / np.where(silhouette, inside, 1.0)
        farther_m = (drawn_m - depth_m) * _distance_at_one_metre(lens)
        visible &= (farther_m <= HIDDEN_M) | (depth_m == 0.0)
    box = (left - _MARGIN * width, top - _MARGIN * height, box_width, box_height)
    pixels = int(np.count_nonzero(whole))
    return ObjectMasks(silhouette, visible, pixels, box if pixels else _NO_BOX)


_NO_BOX = (-1, -1, -1, -1)


def _box(mask: Flags) -> tuple[int, int, int, int]:
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if not len(rows):
        return _NO_BOX
    left, top = int(columns[0]), int(rows[0])
    return left, top, int(columns[-1]) - left, int(rows[-1]) - top


def _distance_at_one_metre(lens: Intrinsics) -> NDArray[np.float64]:
    """Return the distance (H, W) from the camera of what has a depth of one metre."""
    x = (np.arange(lens.width) - lens.cx) / lens.fx
    y = (np.arange(lens.height) - lens.cy) / lens.fy
    return np.asarray(np.sqrt(1.0 + x[None, :] ** 2 + y[:, None] ** 2))
