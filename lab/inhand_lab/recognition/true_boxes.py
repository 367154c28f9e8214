"""Measures where a labelled object truly is in the image, and how tall its person is, in pixels."""

from collections.abc import Sequence

import numpy as np
from inhand_schemas.joints import Joint
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.wire.conversion import joints_of

from inhand_lab.datasets.followed_people import follow_people
from inhand_lab.datasets.recorded_frames import RecordedFrame
from inhand_lab.datasets.tracks import true_track
from inhand_lab.recognition.parameters import DEFAULT_RECOGNITION_EVALUATION

HEAD_SHARE = 0.935
"""Share of the stature at which the middle of the head is (Drillis and Contini 1966)."""


def true_boxes(frames: Sequence[RecordedFrame], shape: ObjectShape, camera: Intrinsics) -> Array:
    """Return the left, top, right and bottom (T, 4) of an object's whole mesh.

    They are NaN where no label is, or where the box's centre is outside the image.
    """
    track = true_track(frames)
    placed = rotations.rotate(track.rotations[:, None, :], shape.vertices)
    pixels = camera.project(placed + track.translations[:, None, :])
    boxes = np.concatenate((pixels.min(axis=1), pixels.max(axis=1)), axis=1)
    centres = box_centres(boxes)
    inside = np.all((centres >= 0.0) & (centres < [camera.width, camera.height]), axis=1)
    return np.where(inside[:, None], boxes, np.nan)


def box_centres(boxes: Array) -> Array:
    """Return the centres (T, 2) of boxes (T, 4)."""
    return 0.5 * (boxes[:, :2] + boxes[:, 2:])


def person_pixels(frames: Sequence[RecordedFrame], camera: Intrinsics) -> float:
    """Height in pixels of the person who stands upright in the image; NaN without a body."""
    heights = []
    for followed in follow_people(frames):
        if followed.person is not None:
            pixels = camera.project(joints_of(followed.person))
            feet = pixels[[Joint.ANKLE_LEFT, Joint.ANKLE_RIGHT], 1]
            heights.append((feet.max() - pixels[Joint.HEAD, 1]) / HEAD_SHARE)
    finite = np.array(heights)[np.isfinite(heights)]
    upright = DEFAULT_RECOGNITION_EVALUATION.tall_quantile
    return float(np.quantile(finite, upright)) if len(finite) else float("nan")
