"""Poses, labels and skeletons as Parquet tables, which data frames are read from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
from inhand_recorder.recorded import Recorded
from inhand_runtime.recording import RecordingError
from inhand_schemas.joints import JOINT_NAMES
from inhand_schemas.keys import parse_key
from inhand_schemas.messages import ObjectPose, Pose, Skeletons
from inhand_schemas.topics import LABEL, POSE, SKELETONS

from inhand.exports.request import ExportRequest
from inhand.exports.unfinished import unfinished

_ROWS_AT_ONCE = 20_000
"""Number of rows that wait in memory for their group in the file."""

Row = dict[str, Any]


def _field(name: str, kind: pa.DataType, text: str) -> pa.Field:
    return pa.field(name, kind, metadata={"description": text})


_DICTIONARY = pa.dictionary(pa.int32(), pa.string())
_STAMP = (
    _field("time_ns", pa.int64(), "capture of the frame, nanoseconds since the epoch"),
    _field("received_ns", pa.int64(), "reception by the recorder, nanoseconds since the epoch"),
    _field("sequence", pa.int64(), "number of the frame"),
    _field("rig", _DICTIONARY, "rig"),
    _field("camera", _DICTIONARY, "camera of the frame"),
)
_POSE = tuple(
    _field(f"{prefix}{name}", pa.float64(), f"{text}, {of}")
    for prefix, of in (("", "camera_from_object"), ("rig_", "rig_from_object"))
    for name, text in (
        ("x_m", "translation, metres"),
        ("y_m", "translation, metres"),
        ("z_m", "translation, metres"),
        ("qw", "unit quaternion"),
        ("qx", "unit quaternion"),
        ("qy", "unit quaternion"),
        ("qz", "unit quaternion"),
    )
)
POSES = pa.schema(
    [
        *_STAMP,
        _field("object", _DICTIONARY, "object"),
        _field("state", _DICTIONARY, "tracked, predicted or lost"),
        _field("confidence", pa.float64(), "0 to 1"),
        _field("person", pa.int64(), "whose hand it is in; null where that is not known"),
        *_POSE,
        _field(
            "covariance",
            pa.list_(pa.float64(), 36),
            "6 × 6 row by row of translation (metres) and rotation vector (radians, applied on the "
            "left) in the camera frame; null where it is not known",
        ),
        _field("box_left_px", pa.float64(), "rectangle in the image, pixels"),
        _field("box_top_px", pa.float64(), "rectangle in the image, pixels"),
        _field("box_width_px", pa.float64(), "rectangle in the image, pixels"),
        _field("box_height_px", pa.float64(), "rectangle in the image, pixels"),
        _field("visible_fraction", pa.float64(), "share of its pixels that nothing hides"),
        _field("contact", _DICTIONARY, "what carries it"),
    ]
)
JOINTS = pa.schema(
    [
        *_STAMP,
        _field("person", pa.int64(), "number of the person"),
        _field("joint", _DICTIONARY, "one of the twenty joints"),
        _field("x_m", pa.float64(), "place in the camera frame, metres; null where missing"),
        _field("y_m", pa.float64(), "place in the camera frame, metres; null where missing"),
        _field("z_m", pa.float64(), "place in the camera frame, metres; null where missing"),
        _field("state", _DICTIONARY, "missing, inferred or tracked"),
        _field("confidence", pa.float64(), "0 to 1"),
        _field("convention", _DICTIONARY, "whose joints these are"),
    ]
)
TABLES = {POSE.stream: ("poses", POSES), LABEL.stream: ("labels", POSES)} | {
    SKELETONS.stream: ("skeletons", JOINTS)
}
"""The table's name and columns of each stream."""


def export_parquet(request: ExportRequest, output: Path) -> dict[str, int]:
    """Write a folder with a table for each of poses, labels and skeletons that are selected.

    Returns the numbers of rows by table; raises RecordingError where none of them is there.
    """
    keys = request.of(POSE, LABEL, SKELETONS)
    if not keys:
        raise RecordingError("there are no poses, labels or skeletons: nothing is to be exported")
    tables: dict[str, _Table] = {}
    with unfinished(output) as folder:
        folder.mkdir()
        try:
            for key in keys:
                name, schema = TABLES[parse_key(key).stream]
                if name not in tables:
                    tables[name] = _Table(folder / f"{name}.parquet", schema)
            for one in request.read(keys):
                tables[TABLES[parse_key(one.key).stream][0]].add(_rows(one))
        finally:
            for table in tables.values():
                table.close()
    return {name: table.rows for name, table in tables.items()}


@dataclass
class _Table:
    path: Path
    schema: pa.Schema
    rows: int = 0
    _waiting: list[Row] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._writer = pq.ParquetWriter(self.path, self.schema, compression="zstd")

    def add(self, rows: Iterator[Row]) -> None:
        self._waiting.extend(rows)
        if len(self._waiting) >= _ROWS_AT_ONCE:
            self._flush()

    def close(self) -> None:
        self._flush()
        self._writer.close()

    def _flush(self) -> None:
        if self._waiting:
            self._writer.write_table(pa.Table.from_pylist(self._waiting, self.schema))
        self.rows += len(self._waiting)
        self._waiting.clear()


def _rows(one: Recorded) -> Iterator[Row]:
    message, site = one.message, parse_key(one.key).site
    stamp = {
        "time_ns": message.time_ns,
        "received_ns": one.received_ns,
        "sequence": message.sequence,
        "rig": site.rig,
    }
    if isinstance(message, ObjectPose):
        yield stamp | _pose_row(message)
    elif isinstance(message, Skeletons):
        yield from (
            stamp | {"camera": one.name, "convention": message.convention} | row
            for row in _joint_rows(message)
        )


def _pose_row(message: ObjectPose) -> Row:
    box = message.box
    sides = {} if box is None else {f"box_{name}_px": value for name, value in _sides(box).items()}
    return {
        "camera": message.camera,
        "object": message.object,
        "state": message.state,
        "confidence": message.confidence,
        "person": message.person,
        **_numbers("", message.camera_from_object),
        **_numbers("rig_", message.rig_from_object),
        "covariance": message.covariance,
        **sides,
        "visible_fraction": message.visible_fraction,
        "contact": message.contact,
    }


def _sides(box: Any) -> Mapping[str, float]:
    return {name: getattr(box, name) for name in ("left", "top", "width", "height")}


def _numbers(prefix: str, pose: Pose | None) -> Row:
    if pose is None:
        return {}
    names = ("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")
    values = (*pose.translation, *pose.rotation)
    return {prefix + name: value for name, value in zip(names, values, strict=True)}


def _joint_rows(message: Skeletons) -> Iterator[Row]:
    for person in message.people:
        for name, place, state, confidence in zip(
            JOINT_NAMES, person.joints, person.states, person.confidences, strict=True
        ):
            x, y, z = (None, None, None) if state == "missing" else place
            at = {"x_m": x, "y_m": y, "z_m": z}
            about = {"joint": name, "state": state, "confidence": confidence}
            yield {"person": person.id, **at, **about}
