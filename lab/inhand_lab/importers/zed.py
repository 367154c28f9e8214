"""Imports skeletons of 34 joints of ZED cameras, as the SDK's sample of JSON export writes them.

The JSON has one entry a frame, by its time in milliseconds: ``timestamp`` in nanoseconds since the
epoch, and ``body_list`` (left out where nobody is in view) with ids, ``tracking_state``,
``keypoint`` and ``keypoint_confidence`` (0 to 100). The file does not name its coordinate system
and its unit; the sample records RIGHT_HANDED_Y_UP.
"""

from collections.abc import Sequence
from pathlib import Path

import msgspec
import numpy as np
from inhand_schemas import conventions
from inhand_schemas.joints import Joint

from inhand_lab.datasets.dataset import Dataset, DatasetError
from inhand_lab.importers.body_checks import wrong_joint_count
from inhand_lab.importers.body_times import checked_times
from inhand_lab.importers.coordinates import Coordinates
from inhand_lab.importers.foreign_bodies import Bodies, ForeignBody, our_bodies, write_bodies
from inhand_lab.importers.joint_tables import (
    INFERRED,
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

SAMPLE_COORDINATES = Coordinates("RIGHT_HANDED_Y_UP")
"""What the SDK's sample in Python records; that in C++ leaves the unit at millimetres."""

_JOINTS = (
    *("PELVIS", "NAVAL_SPINE", "CHEST_SPINE", "NECK"),
    *limb_names("{1}_{0}".format),
    *("HEAD", "NOSE", "LEFT_EYE", "LEFT_EAR", "RIGHT_EYE", "RIGHT_EAR", "LEFT_HEEL", "RIGHT_HEEL"),
)

ZED = JointTable(
    "ZED BODY_34",
    conventions.ZED,
    _JOINTS,
    {
        **trunk("PELVIS", "NAVAL_SPINE", "NECK", NAVEL_SHARE),
        Joint.HEAD: (*middle("LEFT_EAR", "RIGHT_EAR"), JointMean({"HEAD": 1.0}, inferred=True)),
        **limbs("{1}_{0}".format),
    },
    front=feet("{1}_{0}".format),
)

_STATES = {"0": "OFF", "1": "OK", "2": "SEARCHING", "3": "TERMINATE"}
"""Names of tracking states by the numbers that the sample in C++ writes."""
_SEEN_STATES = ("OFF", "OK")


class _Body(msgspec.Struct, frozen=True):
    id: int
    tracking_state: int | str
    keypoint: list[tuple[float | None, float | None, float | None]] = []
    keypoint_confidence: list[float | None] = []


class _Frame(msgspec.Struct, frozen=True):
    timestamp: int
    body_list: list[_Body] | None = None


def import_zed(
    sources: Sequence[Path],
    folder: Path,
    frame_rate: float = DEFAULT_IMPORT.frame_rate,
    coordinates: Coordinates = SAMPLE_COORDINATES,
) -> Dataset:
    """Import JSON files, or folders of them, as skeletons, one recording each.

    Files that cannot be read or show nobody are named and left out. Raises DatasetError where all
    are, or InhandError.
    """
    files = read_files(find_files(sources, ".json"), lambda path: read_zed(path, coordinates))
    return write_bodies(files, folder, frame_rate, {"importer": "zed"})


def read_zed(path: Path, coordinates: Coordinates = SAMPLE_COORDINATES) -> Bodies:
    """Read one file; raises DatasetError."""
    entries = converted(path, read_json(path), dict[str, _Frame], "ZED's sample of JSON export")
    # The sample writes an entry before the camera has given anything.
    frames = [one for one in entries.values() if one.timestamp > 0 or one.body_list]
    bodies = [
        _foreign(path, index, body, coordinates)
        for index, frame in enumerate(frames)
        for body in frame.body_list or ()
        if body.keypoint
    ]
    times_ns = checked_times(
        path, [frame.timestamp for frame in frames], "timestamp, in nanoseconds since 1970"
    )
    return our_bodies(path, ZED, times_ns, bodies, coordinates.mends())


def _foreign(path: Path, frame: int, body: _Body, coordinates: Coordinates) -> ForeignBody:
    _check_format(path, body)
    places = coordinates.to_camera(np.array(body.keypoint, float))
    confidences = np.array(body.keypoint_confidence, float) / 100.0
    confidences = np.clip(np.nan_to_num(confidences, nan=0.0), 0.0, 1.0)
    states = np.where(confidences >= DEFAULT_IMPORT.tracked_from, TRACKED, INFERRED)
    if _state_name(body.tracking_state) not in _SEEN_STATES:
        states = np.minimum(states, INFERRED)
    return ForeignBody(frame, body.id, places, states, confidences)


def _check_format(path: Path, body: _Body) -> None:
    if len(body.keypoint) != len(ZED.joints):
        raise DatasetError(
            f"{wrong_joint_count(path, ZED, len(body.keypoint))}; record it with body_format "
            "BODY_34 and body fitting"
        )
    if len(body.keypoint_confidence) != len(body.keypoint):
        raise DatasetError(
            f"{path}: a body has {len(body.keypoint)} joints, and confidences of "
            f"{len(body.keypoint_confidence)}: the file is not as ZED's sample writes it"
        )


def _state_name(state: int | str) -> str:
    """Return the name of a tracking state, OK say, written as 1, OK or OBJECT_TRACKING_STATE.OK."""
    text = str(state).rpartition(".")[2].upper()
    return _STATES.get(text, text)
