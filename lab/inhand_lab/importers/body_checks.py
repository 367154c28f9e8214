"""Checks that bodies of an import can be meant: their unit, axes, order of joints and sides."""

import logging
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_schemas.joints import Joint
from inhand_tracker.body.skeleton import PARTS, part_lengths, typical_lengths
from inhand_tracker.geometry.arrays import Array

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.datasets.facing import is_mirror_image, pointing_forwards
from inhand_lab.datasets.units import measured_stature, unit_of_stature
from inhand_lab.importers.joint_tables import JointTable
from inhand_lab.importers.parameters import DEFAULT_IMPORT

log = logging.getLogger(__name__)

JOINT_COUNTS = {
    17: "COCO (`inhand import coco`) and Human3.6M",
    18: "OpenPose and ZED's BODY_18",
    20: "the first Kinect",
    25: "Kinect 2 (`inhand import ntu`)",
    32: "Azure Kinect (`inhand import azure-kinect`)",
    33: "BlazePose",
    34: "ZED's BODY_34 (`inhand import zed`)",
    38: "ZED's BODY_38",
    133: "COCO-WholeBody",
}
"""Whose skeletons have how many joints."""


@dataclass(frozen=True)
class Mends:
    """What mends bodies in another unit (``{unit}`` is where its name goes) or other axes.

    ``unit_m`` is the length in metres of the unit that they were taken to be in.
    """

    unit: str
    axes: str
    unit_m: float = 1.0


def check_joint_count(path: Path, table: JointTable, count: int) -> None:
    """Raise DatasetError where bodies have another number of joints than the convention."""
    if count != len(table.joints):
        raise DatasetError(wrong_joint_count(path, table, count))


def wrong_joint_count(path: Path, table: JointTable, count: int) -> str:
    """Say that bodies have another number of joints than the convention, and whose it is."""
    whose = f"; {count} are those of {JOINT_COUNTS[count]}" if count in JOINT_COUNTS else ""
    return f"{path}: a body has {count} joints, and {table.name}'s have {len(table.joints)}{whose}"


def check_bodies(
    path: Path, table: JointTable, joints: Array, directions: Array, mends: Mends
) -> None:
    """Check our joints (N, 20, 3) of all bodies of a file, NaN where missing.

    ``directions`` (N, 3) should point forwards of the bodies. Raises DatasetError for joints in
    another unit, behind the camera, relative to the hips, in another order, or of mirror images;
    warns where people are not upright.
    """
    with np.errstate(invalid="ignore", over="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of medians of nothing
        lengths = part_lengths(joints)
        _check_unit(path, measured_stature(lengths), mends)
        _check_parts(path, table, typical_lengths(lengths))
        _check_place(path, joints, mends)
        _warn_of_lying(path, joints, mends)
    _check_sides(path, pointing_forwards(joints, directions), mends)


def _check_sides(path: Path, pointing: Array, mends: Mends) -> None:
    if is_mirror_image(pointing):
        raise DatasetError(
            f"{path}: bodies are mirror images, {int((pointing < 0.0).sum())} of {len(pointing)} "
            f"look backwards: left and right joints have each other's names, or {mends.axes}"
        )


def _check_unit(path: Path, stature: float, mends: Mends) -> None:
    if not np.isfinite(stature) or unit_of_stature(stature) == "metres":
        return
    unit = unit_of_stature(stature / mends.unit_m)
    mend = "no unit makes them a person" if unit is None else mends.unit.format(unit=unit)
    raise DatasetError(f"{path}: a person would be {stature:.3g} m tall: {mend}")


def _check_parts(path: Path, table: JointTable, lengths: Array) -> None:
    for name, length in zip(PARTS, lengths.tolist(), strict=True):
        if length > DEFAULT_IMPORT.longest_part_m:
            raise DatasetError(
                f"{path}: {name} is {length:.2f} m from its parent joint, as in nobody: the joints "
                f"are in another order than {table.name}'s, {', '.join(table.joints[:3])}, …"
            )


def _check_place(path: Path, joints: Array, mends: Mends) -> None:
    hips = joints[:, Joint.HIP_CENTER]
    if np.nanmedian(np.linalg.norm(hips, axis=1)) < DEFAULT_IMPORT.nearest_body_m:
        raise DatasetError(
            f"{path}: the hips are at the origin: joints are relative to them; add where the hips "
            "are before the camera"
        )
    if np.nanmedian(joints[..., 2]) <= 0.0:
        raise DatasetError(f"{path}: people are behind the camera: {mends.axes}")


def _warn_of_lying(path: Path, joints: Array, mends: Mends) -> None:
    trunks = joints[:, Joint.SHOULDER_CENTER] - joints[:, Joint.HIP_CENTER]
    upwards = np.nanmedian(-trunks[:, 1] / np.linalg.norm(trunks, axis=1))
    if upwards < DEFAULT_IMPORT.upright_share:
        log.warning(
            "%s: people are not upright in the camera's image: they lie, the camera looks down or "
            "is turned, or %s",
            path,
            mends.axes,
        )
