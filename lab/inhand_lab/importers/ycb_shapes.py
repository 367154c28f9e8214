"""Finds shapes of YCB-Video's objects: their models, or what the frames show of them."""

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import ObjectShape

from inhand_lab.importers.images import read_image
from inhand_lab.importers.matlab import read_mat
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.shapes import shape_of_mesh, shape_of_points
from inhand_lab.importers.ycb_annotations import CLASS_NAMES, META_SUFFIX

LABEL_SUFFIX = "-label.png"
MODEL_FILES = ("textured.obj", "textured_simple.obj")


def find_shape(name: str, root: Path, frames: Sequence[Path]) -> ObjectShape | None:
    """Load ``models/NAME/textured.obj``, or else the hull of the surface that a frame shows.

    The surface comes from a ``-meta.mat`` (``vertmap``, the object's coordinates pixel by pixel).
    None where there is neither. Raises DatasetError.
    """
    shape = model_shape(name, root)
    if shape is None:
        points = seen_points(name, frames)
        shape = None if points is None else shape_of_points(name, points)
    return shape


def model_shape(name: str, root: Path) -> ObjectShape | None:
    """Load ``models/NAME/textured.obj``, None where it is missing; raises DatasetError."""
    for file in MODEL_FILES:
        path = root / "models" / name / file
        if path.is_file():
            return shape_of_mesh(name, path)
    return None


def seen_points(name: str, frames: Sequence[Path]) -> Array | None:
    """Return the surface (N, 3) in the first frame with enough of it; raises DatasetError."""
    for frame in frames:
        points = _visible_surface(name, frame)
        if len(points) >= DEFAULT_IMPORT.fewest_points:
            return points
    return None


def _visible_surface(name: str, frame: Path) -> Array:
    meta = frame.with_name(frame.name + META_SUFFIX)
    labels = frame.with_name(frame.name + LABEL_SUFFIX)
    if not (meta.is_file() and labels.is_file()):
        return np.empty((0, 3))
    (surface,) = read_mat(meta, "vertmap")
    shown = read_image(labels, cv2.IMREAD_UNCHANGED) == CLASS_NAMES.index(name) + 1
    if shown.shape != surface.shape[:2]:
        return np.empty((0, 3))
    points = surface[shown].astype(np.float64)
    return points[np.isfinite(points).all(axis=1)]
