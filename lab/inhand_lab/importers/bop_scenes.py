"""Reads the scenes of BOP data sets (https://bop.felk.cvut.cz; the scene-wise format).

A scene's folder holds ``scene_camera.json`` (``cam_K``, ``depth_scale``), ``scene_gt.json`` (object
and pose in the camera, millimetres), perhaps ``scene_gt_info.json`` (``visib_fract``), and the
images ``rgb`` or ``gray``, and ``depth``. A data set with several sensors appends the sensor to
each of these names: ``scene_gt_realsense.json``, ``rgb_realsense``.
"""

import logging
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from inhand_runtime.wording import counted
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.importers.bop_models import M_PER_MM, bop_object_name, read_bop_json
from inhand_lab.importers.parameters import DEFAULT_IMPORT

log = logging.getLogger(__name__)

TRUTH, CAMERA_FILE, TRUTH_INFO = "scene_gt", "scene_camera", "scene_gt_info"
IMAGE_SUFFIXES = (".png", ".jpg", ".jpeg", ".tif", ".tiff")


class _Camera(msgspec.Struct, frozen=True):
    matrix: tuple[float, ...] = msgspec.field(name="cam_K")
    depth_scale: float = 1.0


class _Instance(msgspec.Struct, frozen=True):
    obj_id: int
    turn: tuple[float, ...] = msgspec.field(name="cam_R_m2c")
    shift: tuple[float, ...] = msgspec.field(name="cam_t_m2c")


class _InstanceInfo(msgspec.Struct, frozen=True):
    visib_fract: float | None = None


@dataclass(frozen=True)
class BopCamera:
    """A pinhole camera in pixels, and the length in metres of one unit of its depth."""

    fx: float
    fy: float
    cx: float
    cy: float
    depth_scale: float


@dataclass(frozen=True)
class BopLabel:
    """An object's true camera_from_object, (3,) in metres and (4,).

    ``name`` is the object's; of the second instance of it in a frame it ends in ``_2``, and so on.
    """

    object_id: int
    name: str
    translation: Array
    rotation: Array
    visible_fraction: float | None


@dataclass(frozen=True)
class BopFrame:
    """One image of a scene; ``colour`` may be grey, and one of the two files missing."""

    number: int
    camera: BopCamera
    colour: Path | None
    depth: Path | None
    labels: tuple[BopLabel, ...]


@dataclass(frozen=True)
class BopScene:
    """A scene as one sensor saw it; ``name`` is ``test_000001``, and the sensor's after it.

    ``labelled`` says whether it has a file of truth: test scenes of a challenge have none.
    """

    folder: Path
    name: str
    frames: tuple[BopFrame, ...]
    labelled: bool


def read_scenes(source: Path) -> list[BopScene]:
    """Read the labelled scenes of a data set, of one of its splits, or one scene.

    Warns of scenes without truth or with damaged files, and of frames without an image, which are
    left out. Raises DatasetError where no scene is left.
    """
    if not source.is_dir():
        raise DatasetError(f"{source} is no folder: name the folder of a BOP data set")
    scenes, errors = [], []
    for path in find_camera_files(source):
        sensor = path.stem.removeprefix(CAMERA_FILE)
        if not path.with_name(f"{TRUTH}{sensor}.json").is_file():
            log.warning("%s has no %s%s.json: left out", path.parent, TRUTH, sensor)
            continue
        try:
            scenes.append(read_scene(path))
        except DatasetError as error:
            errors.append(error)
    if errors and not scenes:
        raise errors[0]
    for reason in errors:
        log.warning("%s; the scene is left out", reason)
    if not scenes:
        raise DatasetError(
            f"{source} holds no test/000001/{TRUTH}.json with a {CAMERA_FILE}.json: name the "
            "folder of a BOP data set, of a split (test) or of a scene (test/000001)"
        )
    return scenes


def find_camera_files(source: Path) -> list[Path]:
    """Find the ``scene_camera….json``, one of each scene and sensor, of a data set, of one of its
    splits, or of one scene."""
    patterns = (f"{depth}{CAMERA_FILE}*.json" for depth in ("", "*/", "*/*/"))
    return [path for pattern in patterns for path in sorted(source.glob(pattern))]


def read_scene(cameras_file: Path) -> BopScene:
    """Read a scene by its ``scene_camera….json``, without labels where it has no truth.

    Warns of frames without an image, which are left out; raises DatasetError for damaged files.
    """
    folder = cameras_file.parent
    sensor = cameras_file.stem.removeprefix(CAMERA_FILE)
    truth_file = folder / f"{TRUTH}{sensor}.json"
    cameras = read_bop_json(cameras_file, dict[int, _Camera])
    labelled = truth_file.is_file()
    truth = read_bop_json(truth_file, dict[int, tuple[_Instance, ...]]) if labelled else {}
    visible = _visible_fractions(folder / f"{TRUTH_INFO}{sensor}.json", truth)
    if missing := sorted(set(truth) - set(cameras)):
        raise DatasetError(f"{cameras_file} has no image {missing[0]}, and {truth_file.name} has")
    colour = _images(folder, [f"rgb{sensor}", f"gray{sensor}"])
    depth = _images(folder, [f"depth{sensor}"])
    if not colour and not depth:
        raise DatasetError(f"{folder} holds no images rgb{sensor}, gray{sensor} or depth{sensor}")
    frames = tuple(
        BopFrame(
            number,
            _camera(f"{cameras_file}, image {number}", cameras[number]),
            colour.get(number),
            depth.get(number),
            _labels(f"{truth_file}, image {number}", truth.get(number, ()), visible.get(number)),
        )
        for number in sorted(cameras)
        if number in colour or number in depth
    )
    if lacking := len(cameras) - len(frames):
        log.warning("%s: %d of %d frames have no image: left out", folder, lacking, len(cameras))
    if not frames:
        raise DatasetError(f"{folder}: no image is named by a number of {cameras_file.name}")
    for what, files in (("colour", colour), ("depth", depth)):
        without = sum(frame.number not in files for frame in frames)
        if files and without:
            log.warning("%s: %d of %d frames have no %s", folder, without, len(frames), what)
    resolved = folder.resolve()
    return BopScene(folder, f"{resolved.parent.name}_{resolved.name}{sensor}", frames, labelled)


def _images(folder: Path, names: Sequence[str]) -> dict[int, Path]:
    """The images of the first of some folders that has any, by number."""
    for name in names:
        paths = sorted((folder / name).glob("*"))
        found = {
            int(path.stem): path
            for path in paths
            if path.suffix.lower() in IMAGE_SUFFIXES and path.stem.isdecimal()
        }
        if found:
            return found
    return {}


def _camera(where: str, camera: _Camera) -> BopCamera:
    values = np.array(camera.matrix)
    if values.shape != (9,) or not np.isfinite(values).all():
        raise DatasetError(f"{where}: cam_K is not 9 finite numbers")
    matrix = values.reshape(3, 3)
    pinhole = np.array([[matrix[0, 0], 0.0, matrix[0, 2]], [0.0, matrix[1, 1], matrix[1, 2]]])
    if np.abs(matrix - np.vstack((pinhole, [0.0, 0.0, 1.0]))).max() > DEFAULT_IMPORT.most_skew:
        raise DatasetError(
            f"{where}: cam_K is no [fx, 0, cx, 0, fy, cy, 0, 0, 1], row by row: a camera with skew "
            "is not read"
        )
    if not camera.depth_scale > 0.0:
        raise DatasetError(f"{where}: depth_scale is {camera.depth_scale:g}, and must be above 0")
    fx, cx, fy, cy = (float(matrix[place]) for place in ((0, 0), (0, 2), (1, 1), (1, 2)))
    return BopCamera(fx, fy, cx, cy, camera.depth_scale * M_PER_MM)


def _visible_fractions(path: Path, truth: dict[int, Any]) -> dict[int, list[float | None]]:
    if not path.is_file():
        return {}
    infos = read_bop_json(path, dict[int, tuple[_InstanceInfo, ...]])
    for number, instances in infos.items():
        if len(instances) != len(truth.get(number, ())):
            raise DatasetError(
                f"{path}: image {number} has {counted(len(instances), 'instance')}, and "
                f"{len(truth.get(number, ()))} in {TRUTH}: make both files together"
            )
    return {number: [one.visib_fract for one in infos[number]] for number in infos}


def _labels(
    where: str, instances: Sequence[_Instance], visible: list[float | None] | None
) -> tuple[BopLabel, ...]:
    counts: dict[int, int] = {}
    labels = []
    for index, one in enumerate(instances):
        count = counts[one.obj_id] = counts.get(one.obj_id, 0) + 1
        name = bop_object_name(one.obj_id) + ("" if count == 1 else f"_{count}")
        translation, rotation = _pose(f"{where}, object {one.obj_id}", one)
        share = None if visible is None else visible[index]
        share = None if share is None else min(max(share, 0.0), 1.0)
        labels.append(BopLabel(one.obj_id, name, translation, rotation, share))
    return tuple(labels)


def _pose(where: str, instance: _Instance) -> tuple[Array, Array]:
    turn, shift = np.array(instance.turn), np.array(instance.shift)
    if turn.shape != (9,) or shift.shape != (3,):
        raise DatasetError(f"{where}: cam_R_m2c and cam_t_m2c are not 9 and 3 numbers")
    matrix = turn.reshape(3, 3)
    if (
        np.abs(matrix @ matrix.T - np.eye(3)).max() > DEFAULT_IMPORT.unit_tolerance
        or np.linalg.det(matrix) < 0.0
    ):
        raise DatasetError(f"{where}: cam_R_m2c is no rotation, row by row")
    if np.linalg.norm(shift) < DEFAULT_IMPORT.nearest_mm:
        raise DatasetError(
            f"{where}: cam_t_m2c is {np.linalg.norm(shift):.3g} mm long, which is in the camera: "
            "it is in millimetres in BOP, not in metres"
        )
    return shift * M_PER_MM, rotations.from_matrix(matrix)
