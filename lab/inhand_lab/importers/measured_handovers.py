"""Reads a handover that was measured segment by segment: two upper bodies and a baton.

A recording is CSV files such as ``giver_chest_pose_saved.csv``, in a folder or in an archive
(``.tar.xz``) that a folder may hold: a segment's pose is x, y, z and a quaternion of its near end.
Of the right hands nothing was measured (their file is the left hand's), so that a right wrist is
where the forearm points, as far as the left one is; hands and legs are not read. The baton's two
ends tell by which force they are held.
"""

import tarfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path, PurePosixPath

import numpy as np
from inhand_schemas.joints import JOINT_NAMES
from inhand_tracker.geometry.arrays import Array
from scipy.spatial.transform import Rotation

from inhand_lab.datasets.dataset import DatasetError

RATE_HZ = 120.0
PEOPLE = ("giver", "taker")
_SEGMENTS = {
    "HipCenter": "hip",
    "Spine": "ab",
    "ShoulderCenter": "neck",
    "Head": "head",
    "ShoulderLeft": "LUArm",
    "ElbowLeft": "LFArm",
    "WristLeft": "LHand",
    "ShoulderRight": "RUArm",
    "ElbowRight": "RFArm",
}
"""Joints by the segment at whose near end they are."""
MEASURED = tuple(JOINT_NAMES.index(name) for name in (*_SEGMENTS, "WristRight"))
"""The joints of which a recording says where they are."""


@dataclass(frozen=True)
class MeasuredHandover:
    """T frames at ``RATE_HZ`` in the recording's frame, by ``PEOPLE``: their ``joints``
    (T, 20, 3) in metres, NaN of those that were not measured, and the ``forces`` (T,) in newtons
    by which they hold the baton; and its ``translations`` (T, 3) and ``rotations`` (T, 4)."""

    joints: Mapping[str, Array]
    forces: Mapping[str, Array]
    translations: Array
    rotations: Array


def read_measured_handover(path: Path) -> MeasuredHandover:
    """Read a recording; raises DatasetError for what is none."""
    table = _tables(path)
    baton = _poses(table("baton_pose_saved.csv"))
    return MeasuredHandover(
        {who: _joints(table, who) for who in PEOPLE},
        {who: np.linalg.norm(table(f"Wrench_{who}_saved.csv")[:, :3], axis=1) for who in PEOPLE},
        baton[:, :3],
        baton[:, 3:],
    )


def _tables(path: Path) -> Callable[[str], Array]:
    """What reads a table (T, C) of the recording by its file's name."""
    archives = sorted(path.glob("*.tar.xz")) if path.is_dir() else [path]
    if path.is_dir() and not archives:
        return lambda name: _table(path / name, (path / name).read_bytes)
    if len(archives) != 1:
        raise DatasetError(f"{path} holds {len(archives)} archives: name one of them")
    (archive,) = archives
    try:
        with tarfile.open(archive) as opened:
            files = {
                PurePosixPath(member.name).name: file.read()
                for member in opened.getmembers()
                if (file := opened.extractfile(member)) is not None
            }
    except (OSError, tarfile.TarError) as error:
        raise DatasetError(f"{archive} cannot be read: {error}") from None

    def read(name: str) -> bytes:
        if name not in files:
            raise FileNotFoundError
        return files[name]

    return lambda name: _table(archive / name, lambda: read(name))


def _table(path: Path, read: Callable[[], bytes]) -> Array:
    try:
        table = np.genfromtxt(BytesIO(read()), delimiter=",", skip_header=1)
    except FileNotFoundError:
        raise DatasetError(
            f"{path} is missing: name a folder or archive of a measured handover"
        ) from None
    except (OSError, ValueError) as error:
        raise DatasetError(f"{path} cannot be read: {error}") from None
    if table.ndim != 2 or table.shape[1] < 6 or not np.isfinite(table).all():
        raise DatasetError(f"{path} is no table of numbers")
    return np.asarray(table)


def _poses(table: Array) -> Array:
    """Poses (T, 7) of a segment: x, y, z, then w, x, y, z."""
    return table[:, [0, 1, 2, 6, 3, 4, 5]]


def _joints(table: Callable[[str], Array], who: str) -> Array:
    segments = {
        name: _poses(table(f"{who}_{part}_pose_saved.csv")) for name, part in _SEGMENTS.items()
    }
    left, right = segments["ElbowLeft"], segments["ElbowRight"]
    ahead = _turns(left).inv().apply(segments["WristLeft"][:, :3] - left[:, :3])
    mirrored = np.median(ahead, axis=0) * [-1.0, 1.0, 1.0]
    wrist = right[:, :3] + _turns(right).apply(mirrored)
    joints = np.full((len(wrist), len(JOINT_NAMES), 3), np.nan)
    joints[:, MEASURED] = np.stack([*(one[:, :3] for one in segments.values()), wrist], axis=1)
    return joints


def _turns(poses: Array) -> Rotation:
    return Rotation.from_quat(poses[:, 3:], scalar_first=True)
