"""Where a labelled object truly is in the image, and how tall its person is there, in pixels."""

from collections.abc import Sequence

import numpy as np
from inhand_schemas.joints import Joint
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.wire.conversion import joints_of

from inhand_lab.datasets.recorded_frames import RecordedFrame
from inhand_lab.datasets.tracks import true_track

HEAD_SHARE = 0.935
"""The middle of the head is at this share of the stature (Drillis and Contini 1966)."""


def true_boxes(frames: Sequence[RecordedFrame], shape: ObjectShape, camera: Intrinsics) -> Array:
    """Left, top, right and bottom (T, 4) of an object's whole mesh.

    NaN where no label is, or where the box's centre is outside the image.
    """
    track = true_track(frames)
    placed = rotations.rotate(track.rotations[:, None, :], shape.vertices)
    pixels = camera.project(placed + track.translations[:, None, :])
    boxes = np.concatenate((pixels.min(axis=1), pixels.max(axis=1)), axis=1)
    centre = centres(boxes)
    inside = np.all((centre >= 0.0) & (centre < [camera.width, camera.height]), axis=1)
    return np.where(inside[:, None], boxes, np.nan)


def centres(boxes: Array) -> Array:
    """The centres (T, 2) of boxes (T, 4)."""
    return 0.5 * (boxes[:, :2] + boxes[:, 2:])


def person_pixels(frames: Sequence[RecordedFrame], camera: Intrinsics) -> float:
    """How tall the person stands in the image: the tallest tenth of frames; NaN without a body."""
    tall = []
    for frame in frames:
        for person in frame.people[:1]:
            pixels = camera.project(joints_of(person))
            feet = pixels[[Joint.ANKLE_LEFT, Joint.ANKLE_RIGHT], 1]
            tall.append((feet.max() - pixels[Joint.HEAD, 1]) / HEAD_SHARE)
    known = np.array(tall)[np.isfinite(tall)]
    return float(np.quantile(known, 0.9)) if len(known) else float("nan")
