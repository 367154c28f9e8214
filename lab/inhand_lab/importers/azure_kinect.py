"""Imports skeletons of Azure Kinect Body Tracking, as its sample offline_processor writes them.

The JSON holds ``joint_names`` and ``frames``: of each its time since the device was started and
its bodies, of each of these its id and its joints' positions, in millimetres in the depth camera's
frame, whose axes are OpenCV's. Confidences are not in it, so every joint counts as tracked.
"""

from collections.abc import Sequence
from pathlib import Path

import msgspec
import numpy as np
from inhand_schemas import conventions
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array

from inhand_lab.datasets.dataset import Dataset, DatasetError
from inhand_lab.importers.body_checks import Mends, check_joint_count
from inhand_lab.importers.body_times import times_since_start
from inhand_lab.importers.foreign_bodies import Bodies, ForeignBody, our_bodies, write_bodies
from inhand_lab.importers.joint_tables import (
    NAVEL_SHARE,
    TRACKED,
    JointMean,
    JointTable,
    feet,
    limb_names,
    limbs,
    middle,
    trunk,
)
from inhand_lab.importers.json_file import converted, read_json
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.sources import find_files, read_files

M_PER_MM = 0.001
NS_PER_US = 1000

_JOINTS = (
    *("PELVIS", "SPINE_NAVEL", "SPINE_CHEST", "NECK"),
    *limb_names("{}_{}".format),
    *("HEAD", "NOSE", "EYE_LEFT", "EAR_LEFT", "EYE_RIGHT", "EAR_RIGHT"),
)
_OTHER_NAMES = {"SPINE_NAVAL": "SPINE_NAVEL"}
"""Names of joints in the vendor's documentation that differ from those in its files."""

AZURE_KINECT = JointTable(
    "Azure Kinect",
    conventions.AZURE_KINECT,
    _JOINTS,
    {
        **trunk("PELVIS", "SPINE_NAVEL", "NECK", NAVEL_SHARE),
        Joint.HEAD: (*middle("EAR_LEFT", "EAR_RIGHT"), JointMean({"HEAD": 1.0}, inferred=True)),
        **limbs("{}_{}".format),
    },
    front=feet("{}_{}".format),
)

_MENDS = Mends(
    "joints seem to be in {unit}, and Azure Kinect's are in millimetres; write them so",
    "axes are not those of the depth camera (x right, y down, z forwards): write them so",
    M_PER_MM,
)


class _Body(msgspec.Struct, frozen=True):
    body_id: int
    joint_positions: list[tuple[float | None, float | None, float | None]]


class _Frame(msgspec.Struct, frozen=True):
    timestamp_usec: int
    bodies: list[_Body]


class _File(msgspec.Struct, frozen=True):
    joint_names: list[str]
    frames: list[_Frame]


def import_azure_kinect(
    sources: Sequence[Path], folder: Path, frame_rate: float = DEFAULT_IMPORT.frame_rate
) -> Dataset:
    """Import JSON files, or folders of them, as skeletons, one recording each.

    Files that cannot be read or show nobody are named and left out. Raises DatasetError where all
    are, or InhandError.
    """
    files = read_files(find_files(sources, ".json"), read_azure_kinect)
    return write_bodies(files, folder, frame_rate, {"importer": "azure-kinect"})


def read_azure_kinect(path: Path) -> Bodies:
    """Read one file; raises DatasetError."""
    contents = converted(path, read_json(path), _File, "offline_processor")
    order = _order(path, contents.joint_names)
    bodies = [
        _foreign(path, index, body, order)
        for index, frame in enumerate(contents.frames)
        for body in frame.bodies
    ]
    stamps_ns = [NS_PER_US * frame.timestamp_usec for frame in contents.frames]
    times_ns = times_since_start(path, stamps_ns, "timestamp_usec, in microseconds")
    return our_bodies(path, AZURE_KINECT, times_ns, bodies, _MENDS)


def _order(path: Path, names: Sequence[str]) -> list[int]:
    """Return where a file has the joints of the table."""
    check_joint_count(path, AZURE_KINECT, len(names))
    known = [_OTHER_NAMES.get(name, name) for name in names]
    for name in AZURE_KINECT.joints:
        if name not in known:
            raise DatasetError(f"{path}: joint_names has no {name}: these are other joints")
    return [known.index(name) for name in AZURE_KINECT.joints]


def _foreign(path: Path, frame: int, body: _Body, order: Sequence[int]) -> ForeignBody:
    check_joint_count(path, AZURE_KINECT, len(body.joint_positions))
    places: Array = M_PER_MM * np.array(body.joint_positions, float)[order]
    count = len(order)
    return ForeignBody(frame, body.body_id, places, np.full(count, TRACKED), np.ones(count))
