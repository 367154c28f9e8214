"""The lists of a folder in the layout of the TUM RGB-D benchmark: images, camera, true poses."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from pathlib import Path

import numpy as np
from inhand_runtime.errors import InhandError
from inhand_schemas.keys import require_name
from inhand_schemas.messages import CameraInfo, Pose
from inhand_tracker.geometry import rotations
from numpy.typing import NDArray

from inhand.exports.tum import CAMERA_FILE, TRUTH_FILE

FARTHEST_TRUTH_NS = 100_000_000
"""Nanoseconds between two poses at the most, between which one is interpolated."""
WORLD = "world"
"""Name of the object whose poses the benchmark's own files have: the room of the camera."""
_OF_OBJECT = re.compile(r"camera_from_object of (\w+)")

Integers = NDArray[np.int64]
Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Truth:
    """Poses camera_from_object: times (N,) in nanoseconds, translations (N, 3) in metres, unit
    quaternions (N, 4)."""

    object: str
    times_ns: Integers
    translations: Floats
    rotations: Floats

    def at(self, time_ns: int) -> Pose | None:
        """Return the pose at a time, between two where none is of that very time; None where these
        are too far apart."""
        after = int(np.searchsorted(self.times_ns, time_ns))
        if after < len(self.times_ns) and self.times_ns[after] == time_ns:
            return _pose(self.translations[after], self.rotations[after])
        if not 0 < after < len(self.times_ns):
            return None
        begin_ns, end_ns = int(self.times_ns[after - 1]), int(self.times_ns[after])
        if end_ns - begin_ns > FARTHEST_TRUTH_NS:
            return None
        share = (time_ns - begin_ns) / (end_ns - begin_ns)
        first, last = self.rotations[after - 1], self.rotations[after]
        turn = rotations.to_vector(rotations.multiply(last, rotations.conjugate(first)))
        turned = rotations.multiply(rotations.from_vector(share * turn), first)
        move = self.translations[after] - self.translations[after - 1]
        return _pose(self.translations[after - 1] + share * move, turned)


def _lines(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Yield the number and fields of each line that is no comment; raises InhandError."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InhandError(f"cannot read {path}: {error}") from None
    for number, line in enumerate(lines, 1):
        fields = line.replace(",", " ").split()
        if fields and not fields[0].startswith("#"):
            yield number, fields


def read_images(folder: Path, name: str) -> dict[int, Path]:
    """Read the times and paths of a list of images; empty where there is none."""
    if not (folder / name).is_file():
        return {}
    images: dict[int, Path] = {}
    for number, fields in _lines(folder / name):
        where = f"{folder / name}, line {number}"
        if len(fields) != 2:
            raise InhandError(f"{where}: write a time and a file")
        time_ns = _nanoseconds(where, fields[0])
        if images and time_ns <= next(reversed(images)):
            raise InhandError(f"{where}: times must rise from line to line")
        path = (folder / fields[1]).resolve()
        if not path.is_relative_to(folder.resolve()):
            raise InhandError(f"{where}: the file is outside of the folder")
        images[time_ns] = path
    return images


def read_camera(folder: Path, colour: dict[int, Path], depth: dict[int, Path]) -> CameraInfo:
    """Read how the camera sees; raises InhandError with the mend where nothing says it."""
    path = folder / CAMERA_FILE
    if not path.is_file():
        raise InhandError(
            f"{folder} does not say how its camera sees: write {CAMERA_FILE} with `fx fy cx cy "
            "width height depth_factor`, as `525 525 319.5 239.5 640 480 5000` of the "
            "benchmark's own"
        )
    number, fields = next(_lines(path), (1, []))
    where = f"{path}, line {number}"
    values = [_number(where, field) for field in fields]
    if len(values) < 7:
        raise InhandError(f"{where}: write fx fy cx cy width height depth_factor")
    fx, fy, cx, cy, width, height, factor, *distortion = values
    times = list(colour or depth)
    try:
        return CameraInfo(
            sequence=0,
            time_ns=times[0],
            width=int(width),
            height=int(height),
            fx=fx,
            fy=fy,
            cx=cx,
            cy=cy,
            distortion=tuple(distortion),
            depth_scale=1.0 / factor,
            frame_rate=_frame_rate(times),
            has_colour=bool(colour),
            has_depth=bool(depth),
        )
    except (ValueError, ZeroDivisionError) as error:
        raise InhandError(f"{where}: {error}") from None


def _frame_rate(times: list[int]) -> float:
    """Return the usual rate of frames in hertz; 30 of a single one."""
    steps = np.diff(times)
    return float(1e9 / np.median(steps)) if len(steps) else 30.0


def read_truth(folder: Path, object_name: str | None) -> Truth | None:
    """Read the true poses, as camera_from_object; None where there are none."""
    path = folder / TRUTH_FILE
    if not path.is_file():
        return None
    heads = [line for line in path.read_text().splitlines() if line.startswith("#")]
    ours = next((found for line in heads if (found := _OF_OBJECT.search(line))), None)
    name = object_name or (ours[1] if ours else WORLD)
    require_name("object", name)
    rows = []
    for number, fields in _lines(path):
        where = f"{path}, line {number}"
        if len(fields) != 8:
            raise InhandError(f"{where}: write timestamp tx ty tz qx qy qz qw")
        pose = [_number(where, field) for field in fields[1:]]
        if not abs(np.linalg.norm(pose[3:]) - 1.0) < 1e-2:
            raise InhandError(f"{where}: qx qy qz qw is no unit quaternion")
        rows.append((_nanoseconds(where, fields[0]), pose))
    times_ns = np.array([time_ns for time_ns, _ in rows], np.int64)
    poses = np.array([pose for _, pose in rows]).reshape(-1, 7)
    if not (np.diff(times_ns) > 0).all():
        raise InhandError(f"{path}: times must rise from line to line")
    turned = poses[:, [6, 3, 4, 5]]
    if ours is None:
        inverse = rotations.conjugate(rotations.normalise(turned))
        return Truth(name, times_ns, -rotations.rotate(inverse, poses[:, :3]), inverse)
    return Truth(name, times_ns, poses[:, :3], turned)


def _pose(translation: Floats, rotation: Floats) -> Pose:
    x, y, z = map(float, translation)
    w, i, j, k = map(float, rotation)
    return Pose((x, y, z), (w, i, j, k))


def _nanoseconds(where: str, text: str) -> int:
    try:
        time_ns = int(Decimal(text).scaleb(9))
    except (InvalidOperation, ValueError, OverflowError):
        time_ns = -1
    if not 0 <= time_ns < 1 << 63:
        raise InhandError(f"{where}: {text!r} is no time in seconds")
    return time_ns


def _number(where: str, text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = float("nan")
    if not np.isfinite(number):
        raise InhandError(f"{where}: {text!r} is no number")
    return number
