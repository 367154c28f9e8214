"""Imports bodies of COCO's 17 key points in space, from NPZ or JSON.

``keypoints`` (T, 17, 3), or (T, P, 17, 3) of P people, are in the camera's frame, NaN (null)
where not seen; ``times`` (T,) in seconds; ``scores`` (T, 17) or (T, P, 17), from 0 to 1, may be
left out. Key points in pixels are refused.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from inhand_capture.estimation.parameters import DEFAULT_LIFTING
from inhand_schemas import conventions
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array

from inhand_lab.datasets.dataset import Dataset, DatasetError
from inhand_lab.importers.body_checks import check_joint_count
from inhand_lab.importers.body_times import times_since_start
from inhand_lab.importers.coordinates import Coordinates
from inhand_lab.importers.foreign_bodies import Bodies, ForeignBody, our_bodies, write_bodies
from inhand_lab.importers.joint_tables import (
    INFERRED,
    TRACKED,
    Candidates,
    JointAhead,
    JointMean,
    JointTable,
    at,
    middle,
)
from inhand_lab.importers.json_file import read_json
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.sources import find_files, read_files

CAMERA_COORDINATES = Coordinates("IMAGE")

_SIDED = ("eye", "ear", "shoulder", "elbow", "wrist", "hip", "knee", "ankle")
_JOINTS = ("nose", *(f"{side}_{joint}" for joint in _SIDED for side in ("left", "right")))
_NO_TIME_S = 1e10
"""Seconds, three centuries, that lie outside of any recording."""
_FLAT = (
    "key points in pixels have no place in space: `inhand recording skeletons` finds people in "
    "recordings of colour and depth"
)


def _trunk_line(share: float) -> JointMean:
    """The place at a share of the way from the middle of the hips to that of the shoulders."""
    weights = {"hip": (1.0 - share) / 2.0, "shoulder": share / 2.0}
    sides = ("left", "right")
    return JointMean(
        {f"{side}_{name}": weight for name, weight in weights.items() for side in sides},
        inferred=True,
    )


def _beyond(inner: str, outer: str, share: float, *, inferred: bool = False) -> JointMean:
    """The place beyond a limb's outer joint, by a share of the limb."""
    return JointMean({outer: 1.0 + share, inner: -share}, inferred)


def _pair(joint: str) -> tuple[str, str]:
    return f"left_{joint}", f"right_{joint}"


def _head() -> Candidates:
    """The middle of the ears, raised; else that alone; else above the shoulders."""
    up = DEFAULT_LIFTING.head_above / 2.0
    ears = {"left_ear": 0.5, "right_ear": 0.5}
    raised = {"left_shoulder": up, "right_shoulder": up, "left_hip": -up, "right_hip": -up}
    above = _trunk_line(DEFAULT_LIFTING.head)
    return (JointMean(ears | raised), *middle("left_ear", "right_ear"), above)


def _side(side: str, other: str) -> dict[Joint, Candidates]:
    """The joints of one side of a body; COCO knows no hands and feet, which are put where they
    usually are."""
    aside = (1.0 + DEFAULT_LIFTING.shoulders_aside) / 2.0
    shoulder, elbow, wrist = (f"{side}_{name}" for name in ("shoulder", "elbow", "wrist"))
    knee, ankle = f"{side}_knee", f"{side}_ankle"
    shoulders = JointMean({shoulder: aside, f"{other}_shoulder": 1.0 - aside})
    hand = DEFAULT_LIFTING.hand / DEFAULT_LIFTING.forearm
    places = {
        "SHOULDER": (shoulders, *at(shoulder)),
        "ELBOW": (_beyond(shoulder, elbow, DEFAULT_LIFTING.elbow_along), *at(elbow)),
        "WRIST": at(wrist),
        "HAND": (_beyond(elbow, wrist, hand, inferred=True),),
        "HIP": at(f"{side}_hip"),
        "KNEE": at(knee),
        "ANKLE": (_beyond(knee, ankle, DEFAULT_LIFTING.ankle_along), *at(ankle)),
        "FOOT": (JointAhead(ankle, DEFAULT_LIFTING.foot, _pair("hip"), _pair("shoulder")),),
    }
    return {Joint[f"{name}_{side.upper()}"]: place for name, place in places.items()}


COCO = JointTable(
    "COCO",
    conventions.COCO,
    _JOINTS,
    {
        Joint.HIP_CENTER: (_trunk_line(DEFAULT_LIFTING.hip_centre),),
        Joint.SPINE: (_trunk_line(DEFAULT_LIFTING.spine),),
        Joint.SHOULDER_CENTER: (
            _trunk_line(DEFAULT_LIFTING.shoulder_centre),
            JointMean({"left_shoulder": 0.5, "right_shoulder": 0.5}, inferred=True),
        ),
        Joint.HEAD: _head(),
        **_side("left", "right"),
        **_side("right", "left"),
    },
    # COCO knows no feet that say where a body faces.
    front=(JointMean({"left_ear": 0.5, "right_ear": 0.5}), JointMean({"nose": 1.0})),
)


def import_coco(
    sources: Sequence[Path],
    folder: Path,
    frame_rate: float = DEFAULT_IMPORT.frame_rate,
    coordinates: Coordinates = CAMERA_COORDINATES,
) -> Dataset:
    """Import NPZ or JSON files, or folders of them, as skeletons, one recording each.

    Files that cannot be read or show nobody are named and left out. Raises DatasetError where all
    are, or InhandError.
    """
    files = read_files(
        find_files(sources, ".npz", ".json"), lambda path: read_coco(path, coordinates)
    )
    return write_bodies(files, folder, frame_rate, {"importer": "coco"})


def read_coco(path: Path, coordinates: Coordinates = CAMERA_COORDINATES) -> Bodies:
    """Read one file; raises DatasetError."""
    values = _read_values(path)
    points = _key_points(path, values)
    times = _numbers(path, values, "times")
    if times.shape != (len(points),) or not np.isfinite(times).all():
        raise DatasetError(
            f"{path}: times are {times.shape}, and should be a finite number of seconds for each "
            f"of {len(points)} frames"
        )
    scores = _scores(path, values, points)
    places = coordinates.to_camera(points)
    states = np.where(scores >= DEFAULT_IMPORT.tracked_from, TRACKED, INFERRED)
    bodies = [
        ForeignBody(frame, person, *(array[frame, person] for array in (places, states, scores)))
        for frame, person in np.ndindex(*points.shape[:2])
    ]
    bounded = np.clip(times, -_NO_TIME_S, _NO_TIME_S)
    stamps_ns = [round(1e9 * time) for time in (bounded - bounded[:1]).tolist()]
    times_ns = times_since_start(path, stamps_ns, "times, in seconds")
    return our_bodies(path, COCO, times_ns, bodies, coordinates.mends())


def _read_values(path: Path) -> Mapping[str, Any]:
    if path.suffix == ".npz":
        try:
            with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
                return {name: archive[name] for name in archive.files}
        except Exception as error:  # noqa: BLE001 - a reader of foreign files may raise anything
            raise DatasetError(f"{path} is no NPZ that can be read: {error}") from None
    values = read_json(path)
    if not isinstance(values, dict) or "instance_info" in values or "annotations" in values:
        raise DatasetError(f"{path} holds results of pictures, not keypoints and times: {_FLAT}")
    return values


def _numbers(path: Path, values: Mapping[str, Any], name: str) -> Array:
    """Return an array of a file by name, null being NaN; raises DatasetError."""
    if name not in values:
        raise DatasetError(f"{path} has no {name!r}: it should hold keypoints and times")
    try:
        return np.array(values[name], np.float64)
    except (TypeError, ValueError, OverflowError):
        raise DatasetError(f"{path}: {name} are no numbers in an array of one shape") from None


def _key_points(path: Path, values: Mapping[str, Any]) -> Array:
    """Return key points (T, P, 17, 3); raises DatasetError for those that have no depth."""
    points = _numbers(path, values, "keypoints")
    if points.ndim not in (3, 4):
        raise DatasetError(
            f"{path}: keypoints are {points.shape}, and should be (frames, 17, 3) or "
            "(frames, people, 17, 3)"
        )
    check_joint_count(path, COCO, points.shape[-2])
    if points.shape[-1] == 2 or (points.shape[-1] == 3 and _has_scores_for_depths(points)):
        raise DatasetError(f"{path} has no depths: {_FLAT}")
    if points.shape[-1] != 3:
        raise DatasetError(f"{path}: key points have {points.shape[-1]} numbers, and should have 3")
    return points if points.ndim == 4 else points[:, None]


def _has_scores_for_depths(points: Array) -> bool:
    """Whether points (..., 3) are pixels, or shares of a picture, with scores.

    As a body in space it would be far more to the side than ahead, or nearer than 1 m and nowhere
    to the left of the camera or above it.
    """
    seen = points[np.isfinite(points).all(axis=-1)]
    if not len(seen) or (seen[:, 2] < 0.0).any():
        return False
    farthest = DEFAULT_IMPORT.farthest_aside
    pixels = np.abs(seen[:, :2]).max() > farthest > seen[:, 2].max()
    return bool(pixels or ((seen >= 0.0).all() and seen[:, 2].max() <= 1.0))


def _scores(path: Path, values: Mapping[str, Any], points: Array) -> Array:
    """Return scores (T, P, 17) of points, 1 where the file has none; raises DatasetError."""
    if "scores" not in values:
        return np.ones(points.shape[:-1])
    scores = _numbers(path, values, "scores")
    if scores.size != points[..., 0].size or scores.shape[-1:] != (len(COCO.joints),):
        raise DatasetError(
            f"{path}: scores are {scores.shape}, and should be one for each of {len(points)} × "
            f"{points.shape[1]} × {len(COCO.joints)} key points"
        )
    scores = np.nan_to_num(scores.reshape(points.shape[:-1]), nan=0.0)
    if (scores < 0.0).any() or (scores > 1.0).any():
        raise DatasetError(
            f"{path}: scores go from {scores.min():g} to {scores.max():g}; write 0 to 1"
        )
    return scores
