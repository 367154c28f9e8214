"""Reads the annotations of YCB-Video's frames: the camera, and where each object is."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from inhand_runtime.wording import counted
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.importers.matlab import read_mat
from inhand_lab.importers.parameters import DEFAULT_IMPORT

META_SUFFIX = "-meta.mat"
POSES_FILE = "poses.json"

CLASS_NAMES = (
    "002_master_chef_can",
    "003_cracker_box",
    "004_sugar_box",
    "005_tomato_soup_can",
    "006_mustard_bottle",
    "007_tuna_fish_can",
    "008_pudding_box",
    "009_gelatin_box",
    "010_potted_meat_can",
    "011_banana",
    "019_pitcher_base",
    "021_bleach_cleanser",
    "024_bowl",
    "025_mug",
    "035_power_drill",
    "036_wood_block",
    "037_scissors",
    "040_large_marker",
    "051_large_clamp",
    "052_extra_large_clamp",
    "061_foam_brick",
)
"""Names of the objects of classes 1 to 21, in this order."""


@dataclass(frozen=True)
class Annotation:
    """The annotation of one frame.

    ``camera_matrix`` (3, 3) is in pixels, ``depth_divisor`` the number of depth units in a metre;
    ``camera_from_objects`` holds each object's translation (3,) and rotation (4,) by its name.
    """

    camera_matrix: Array
    depth_divisor: float
    camera_from_objects: dict[str, tuple[Array, Array]]


class FramePoses(msgspec.Struct, frozen=True):
    """A frame of ``poses.json``, with its poses (3, 4) by class number."""

    K: list[list[float]]
    depth_divisor: float
    poses_3x4: dict[int, list[list[float]]]


def read_poses_file(root: Path) -> dict[str, FramePoses]:
    """Read ``poses.json`` by frame, empty where there is none; raises DatasetError."""
    path = root / POSES_FILE
    if not path.exists():
        return {}
    try:
        return msgspec.json.decode(path.read_bytes(), type=dict[str, FramePoses])
    except (OSError, msgspec.DecodeError) as error:
        raise DatasetError(f"{path} cannot be read: {error}") from None


def read_annotation(frame: Path, poses: Mapping[str, FramePoses]) -> Annotation:
    """Read the annotation of the frame ``…/data/0000/000001``; raises DatasetError.

    It is that of the frame's ``-meta.mat``, or else its entry in ``poses.json``.
    """
    meta = frame.with_name(frame.name + META_SUFFIX)
    if meta.exists():
        return _read_meta(meta)
    if frame.name in poses:
        entry = poses[frame.name]
        return _annotation(frame, entry.K, entry.depth_divisor, entry.poses_3x4)
    raise DatasetError(f"{frame} has no poses: add {meta.name}, or {frame.name!r} to {POSES_FILE}")


def _read_meta(path: Path) -> Annotation:
    classes, poses, camera_matrix, divisor = read_mat(
        path, "cls_indexes", "poses", "intrinsic_matrix", "factor_depth"
    )
    # MATLAB drops the last axis where it is 1.
    matrices = np.moveaxis(poses.reshape(*poses.shape[:2], -1), -1, 0)
    if len(matrices) != classes.size or divisor.size != 1:
        raise DatasetError(
            f"{path}: {counted(classes.size, 'class', 'classes')} with "
            f"{counted(len(matrices), 'pose')}"
        )
    by_class = dict(zip(classes.ravel().astype(int).tolist(), matrices, strict=True))
    return _annotation(path, camera_matrix, float(divisor.item()), by_class)


def _annotation(
    path: Path, camera_matrix: Any, divisor: float, poses: Mapping[int, Any]
) -> Annotation:
    if not 0.0 < divisor < np.inf:
        raise DatasetError(f"{path}: the depth divisor is {divisor:g}, and must be above 0")
    camera = _matrix(path, "camera matrix", camera_matrix, (3, 3))
    if not (camera[0, 0] > 0.0 and camera[1, 1] > 0.0):
        raise DatasetError(f"{path}: the camera matrix has no focal lengths")
    return Annotation(
        camera,
        divisor,
        {_class_name(path, number): _pose(path, matrix) for number, matrix in poses.items()},
    )


def _class_name(path: Path, number: int) -> str:
    if not 1 <= number <= len(CLASS_NAMES):
        raise DatasetError(f"{path}: there is no class {number} in YCB-Video")
    return CLASS_NAMES[number - 1]


def _pose(path: Path, value: Any) -> tuple[Array, Array]:
    matrix = _matrix(path, "pose", value, (3, 4))
    rotation = matrix[:, :3]
    if (
        np.abs(rotation @ rotation.T - np.eye(3)).max() > DEFAULT_IMPORT.unit_tolerance
        or np.linalg.det(rotation) < 0.0
    ):
        raise DatasetError(f"{path}: a pose holds no rotation")
    return matrix[:, 3], rotations.from_matrix(rotation)


def _matrix(path: Path, what: str, value: Any, shape: tuple[int, int]) -> Array:
    try:
        matrix = np.array(value, np.float64)
    except ValueError:
        matrix = np.empty(0)
    if matrix.shape != shape or not np.isfinite(matrix).all():
        raise DatasetError(f"{path}: the {what} is not {shape[0]} × {shape[1]} finite numbers")
    return matrix
