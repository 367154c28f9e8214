"""The calibration file of a rig (``cameras.toml``): where its cameras are, and how sure that is.

``inhand calibrate`` writes it, capture publishes each camera's pose of it, and who joins cameras
reads their clock offsets there.
"""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Literal

from inhand_schemas.errors import KeyFormatError
from inhand_schemas.fields import UNIT_TOLERANCE
from inhand_schemas.keys import require_name
from inhand_schemas.messages import Pose
from pydantic import AfterValidator, AwareDatetime, Field, ValidationError

from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.settings import Section
from inhand_runtime.settings_errors import explain, suggestion
from inhand_runtime.settings_file import settings_data, values_in

CALIBRATION_VERSION = 1
"""Version of the file's form that this release writes, and the latest that it reads."""
_POSE_KEYS = ("translation", "rotation", "translation_deviation", "rotation_deviation")

Method = Literal["board", "people"]


@dataclass(frozen=True)
class CameraCalibration:
    """Where one camera is in its rig's frame, and how its clock runs.

    ``translation_deviation`` (x, y, z; metres) and ``rotation_deviation`` (about x, y, z; radians)
    are standard deviations along the axes of the rig's frame. ``clock_offset_ns`` is what to ADD to
    the camera's times to have the rig's; None where that was not estimated. ``made`` is when.
    """

    rig_from_camera: Pose
    translation_deviation: tuple[float, float, float]
    rotation_deviation: tuple[float, float, float]
    method: Method
    made: datetime
    clock_offset_ns: int | None = None
    clock_deviation_ns: int | None = None


@dataclass(frozen=True)
class RigCalibration:
    """Each camera's calibration by the camera's name.

    ``frame`` says in words where the rig's frame has its origin and its axes.
    """

    cameras: Mapping[str, CameraCalibration]
    frame: str = ""

    def clock_offset_ns(self, camera: str) -> int:
        """Return what to add to a camera's times to have the rig's; 0 where it is not known."""
        calibrated = self.cameras.get(camera)
        return (calibrated.clock_offset_ns or 0) if calibrated is not None else 0


def read_rig_calibration(path: Path) -> RigCalibration:
    """Read a calibration file; raises SettingsError naming file, line and mend."""
    try:
        checked = _File.model_validate(values_in(settings_data(path), path))
        for name in checked.cameras:
            require_name("camera", name)
    except ValidationError as error:
        raise SettingsError(explain(error, path, (), _File)) from None
    except KeyFormatError as error:
        raise SettingsError(f"{path}: {error}") from None
    cameras = {name: table.calibration() for name, table in checked.cameras.items()}
    return RigCalibration(cameras, checked.frame)


def calibration_of(path: Path, camera: str) -> CameraCalibration:
    """Read one camera's calibration; raises SettingsError, where the file does not name it too."""
    cameras = read_rig_calibration(path).cameras
    if camera not in cameras:
        raise SettingsError(
            f"{path} does not calibrate the camera {camera}{suggestion(camera, sorted(cameras))}: "
            "run `inhand calibrate` with it, or take the setting away"
        )
    return cameras[camera]


def require_place_for_calibration(path: Path) -> None:
    """Raise SettingsError where a file is no calibration, and so is not to be written over."""
    if path.exists():
        try:
            read_rig_calibration(path)
        except SettingsError as error:
            raise SettingsError(
                f"{path} is not written over, since it is no calibration of ours ({error}): "
                "choose another name"
            ) from None


def write_rig_calibration(path: Path, calibration: RigCalibration) -> None:
    """Write a file as a whole or not at all, readable by all, and make its folder where there is
    none; raises InhandError."""
    part = path.with_name(f".{path.name}.unfinished")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InhandError(f"cannot write {path}: {error.strerror}") from None
    try:
        with part.open("w", encoding="utf-8") as file:
            file.write(_text(calibration))
            file.flush()
            os.fsync(file.fileno())
        part.replace(path)
    except OSError as error:
        raise InhandError(f"cannot write {path}: {error.strerror}") from None
    finally:
        part.unlink(missing_ok=True)


def _text(calibration: RigCalibration) -> str:
    lines = [
        "# Where the cameras of a rig are, made by `inhand calibrate`.",
        "# Let capture publish it: [capture.NAME] calibration = the name of this file.",
        "# Lengths are metres, angles radians, quaternions w x y z; deviations are standard ones.",
        "# clock_offset_ns is what to add to the camera's times to have the rig's.",
        f"version = {CALIBRATION_VERSION}",
        f"frame = {_quoted(calibration.frame)}",
    ]
    for name, camera in calibration.cameras.items():
        pose = camera.rig_from_camera
        numbers = (
            pose.translation,
            pose.rotation,
            camera.translation_deviation,
            camera.rotation_deviation,
        )
        lines += ["", f"[cameras.{name}]"]
        lines += [f"{key} = {_row(row)}" for key, row in zip(_POSE_KEYS, numbers, strict=True)]
        if camera.clock_offset_ns is not None:
            lines.append(f"clock_offset_ns = {camera.clock_offset_ns}")
        if camera.clock_deviation_ns is not None:
            lines.append(f"clock_deviation_ns = {camera.clock_deviation_ns}")
        made = camera.made.astimezone(UTC).isoformat(timespec="seconds").replace("+00:00", "Z")
        lines += [f'method = "{camera.method}"', f"made = {made}"]
    return "\n".join(lines) + "\n"


def _row(numbers: tuple[float, ...]) -> str:
    return "[" + ", ".join(repr(float(number)) for number in numbers) + "]"


def _quoted(text: str) -> str:
    """Return a TOML string of a text without control characters."""
    plain = "".join(sign if sign.isprintable() else " " for sign in text)
    return '"' + plain.replace("\\", "\\\\").replace('"', '\\"') + '"'


def _unit(rotation: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
    if abs(sum(part * part for part in rotation) ** 0.5 - 1.0) > UNIT_TOLERANCE:
        raise ValueError("it is no unit quaternion (w, x, y, z)")
    return rotation


def _readable_version(version: int) -> int:
    if version > CALIBRATION_VERSION:
        raise ValueError(
            f"this calibration is of version {version}, for a later release of Inhand than this "
            f"one, which reads version {CALIBRATION_VERSION}: update Inhand"
        )
    return version


FARTHEST_M = 1000.0
"""Metres from its rig's origin beyond which no camera is; the squares of absurd places overflow."""
MOST_CLOCK_NS = 2**62
"""Nanoseconds between two clocks, at the most: 146 years, with which times still are numbers of 64
bits."""

_Number = Annotated[float, Field(allow_inf_nan=False)]
_Metres = Annotated[float, Field(ge=-FARTHEST_M, le=FARTHEST_M, allow_inf_nan=False)]
_Deviation = Annotated[float, Field(ge=0, le=FARTHEST_M, allow_inf_nan=False)]
_Rotation = Annotated[tuple[_Number, _Number, _Number, _Number], AfterValidator(_unit)]


class _Camera(Section):
    """``[cameras.NAME]``."""

    translation: tuple[_Metres, _Metres, _Metres]
    rotation: _Rotation
    translation_deviation: tuple[_Deviation, _Deviation, _Deviation]
    rotation_deviation: tuple[_Deviation, _Deviation, _Deviation]
    clock_offset_ns: Annotated[int, Field(ge=-MOST_CLOCK_NS, le=MOST_CLOCK_NS)] | None = None
    clock_deviation_ns: Annotated[int, Field(ge=0, le=MOST_CLOCK_NS)] | None = None
    method: Method
    made: AwareDatetime

    def calibration(self) -> CameraCalibration:
        return CameraCalibration(
            Pose(self.translation, self.rotation),
            self.translation_deviation,
            self.rotation_deviation,
            self.method,
            self.made,
            self.clock_offset_ns,
            self.clock_deviation_ns,
        )


class _File(Section):
    """The whole file."""

    version: Annotated[int, Field(ge=1), AfterValidator(_readable_version)]
    frame: str = ""
    cameras: Annotated[dict[str, _Camera], Field(min_length=1)]
