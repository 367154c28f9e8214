"""Reads motion archives (.npz): a measured body, and a measured object, in some world frame.

``joints`` (T, J, 3) in metres of the Kinect's joints, or those that were measured, ``joint_names``
(J,), ``object_pose`` (T, 7) as x y z qw qx qy qz, ``vertices`` (M, 3) marked points in the object's
frame, ``fps``, ``interaction``, ``object``, ``participant``, ``handedness``. What was not measured
is NaN or zero. An archive of a body alone has no ``object_pose``, ``vertices`` and ``object``.
"""

import logging
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from inhand_schemas.joints import JOINT_NAMES
from inhand_tracker.body.skeleton import PARTS, part_lengths
from inhand_tracker.geometry.arrays import Array
from numpy.typing import NDArray

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.datasets.parameters import DEFAULT_DATASET
from inhand_lab.datasets.wild_labels import named_frames
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.shapes import object_name
from inhand_lab.importers.sources import NobodyError, without_zeros

log = logging.getLogger(__name__)

_OF_OBJECTS = ("object_pose", "vertices", "object")
"""Arrays that an archive of a body alone has none of."""


@dataclass(frozen=True)
class Motion:
    """One archive, in its world frame.

    ``joints`` (T, 20, 3) are in the order of ``JOINT_NAMES``; ``translations`` (T, 3) and
    ``orientations`` (T, 4) are the object's. Of a body alone these are NaN, there is no
    ``object``, and ``marked_vertices`` (M, 3) are none.
    """

    path: Path
    joints: Array
    translations: Array
    orientations: Array
    marked_vertices: Array
    recorded_rate: float
    interaction: str
    object: str | None
    participant: str
    handedness: Literal["left", "right"]


def read_motion(path: Path) -> Motion:
    """Read one archive, and warn of a body that cannot be; raises DatasetError."""
    values = _read_archive(path)
    joints = _joints(path, values)
    alone = not any(name in values for name in _OF_OBJECTS)
    poses = np.full((len(joints), 7), np.nan)
    if not alone:
        poses = _object_poses(path, values, len(joints))
    recorded_rate = float(_array(path, values, "fps", "fiu", ()))
    if not 0.0 < recorded_rate < np.inf:
        raise DatasetError(f"{path}: fps is {recorded_rate:g}, and must be above 0")
    return Motion(
        path,
        joints,
        poses[:, :3],
        poses[:, 3:],
        np.empty((0, 3)) if alone else _marked_vertices(path, values),
        recorded_rate,
        str(_array(path, values, "interaction", "U", ())),
        None if alone else object_name(str(_array(path, values, "object", "U", ()))),
        str(_array(path, values, "participant", "U", ())),
        _handedness(path, str(_array(path, values, "handedness", "U", ()))),
    )


def _joints(path: Path, values: dict[str, Any]) -> Array:
    names = _array(path, values, "joint_names", "U", (None,)).tolist()
    if len(set(names)) < len(names) or not set(names) <= set(JOINT_NAMES):
        raise DatasetError(
            f"{path}: joint_names are not the 20 joints of a Kinect, or some of them"
        )
    measured = _array(path, values, "joints", "f", (None, len(names), 3)).astype(np.float64)
    ordered = np.full((len(measured), len(JOINT_NAMES), 3), np.nan)
    ordered[:, [JOINT_NAMES.index(name) for name in names]] = measured
    joints = without_zeros(np.where(np.isfinite(ordered), ordered, np.nan))
    if not np.isfinite(joints).all(axis=2).any():
        raise NobodyError(f"{path} has no frame with a body: no joint is ever seen")
    _warn_of_odd_parts(path, joints)
    return joints


def _object_poses(path: Path, values: dict[str, Any], frames: int) -> Array:
    measured = _array(path, values, "object_pose", "f", (frames, 7)).astype(np.float64)
    whole = np.asarray(np.isfinite(measured).all(axis=1) & measured.any(axis=1))
    poses = np.where(whole[:, None], measured, np.nan)
    if np.isnan(poses).all():
        raise DatasetError(f"{path} has no frame with an object: object_pose is nowhere measured")
    off = np.abs(np.linalg.norm(poses[:, 3:], axis=1) - 1.0) > DEFAULT_IMPORT.unit_tolerance
    wild = np.flatnonzero(off).tolist()
    if len(wild) > DEFAULT_DATASET.most_wild_share * whole.sum() and len(wild) > 1:
        raise DatasetError(
            f"{path}: object_pose holds rotations that are no unit quaternions, in "
            f"{named_frames(wild)}"
        )
    if wild:
        log.warning(
            "%s: rotations of the object that are no unit quaternions are left out: %s",
            path,
            named_frames(wild),
        )
    return np.where(off[:, None], np.nan, poses)


def _marked_vertices(path: Path, values: dict[str, Any]) -> Array:
    marked = _array(path, values, "vertices", "f", (None, 3)).astype(np.float64)
    if len(marked) < 3 or not np.isfinite(marked).all():
        raise DatasetError(f"{path}: vertices must be 3 or more finite points")
    return marked


def _warn_of_odd_parts(path: Path, joints: Array) -> None:
    lengths = part_lengths(joints)
    for part, name in enumerate(PARTS):
        seen = lengths[np.isfinite(lengths[:, part]), part]
        if seen.size and np.median(seen) > DEFAULT_IMPORT.longest_part_m:
            log.warning(
                "%s: %s is %.2f m from its parent joint, as in nobody: its joints seem to be "
                "misnamed, so its body poses mean little",
                path,
                name,
                np.median(seen),
            )
            return


def _read_archive(path: Path) -> dict[str, Any]:
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files}
    except Exception as error:  # noqa: BLE001 - a reader of foreign files may raise anything
        raise DatasetError(f"{path} is no motion archive that can be read: {error}") from None


def _array(
    path: Path,
    values: dict[str, Any],
    name: str,
    kinds: str,
    shape: tuple[int | None, ...],
) -> NDArray[Any]:
    array = values.get(name)
    if not isinstance(array, np.ndarray):
        raise DatasetError(f"{path} is no motion archive: it has no {name!r}")
    fits = len(array.shape) == len(shape) and all(
        wanted is None or size == wanted for size, wanted in zip(array.shape, shape, strict=True)
    )
    if not fits or array.dtype.kind not in kinds:
        wanted = " × ".join("any" if size is None else str(size) for size in shape) or "one value"
        raise DatasetError(
            f"{path}: {name!r} is {array.dtype} of shape {array.shape}; it should be "
            f"{'text' if kinds == 'U' else 'numbers'}, {wanted}"
        )
    return array


def _handedness(path: Path, text: str) -> Literal["left", "right"]:
    if text == "left":
        return "left"
    if text == "right":
        return "right"
    raise DatasetError(f"{path}: handedness is {text!r}, and should be left or right")
