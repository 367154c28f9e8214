"""Imports UTD-MHAD: Kinect skeletons and depth of people who mime actions (Chen et al. 2015).

The sensor shows people as a mirror does, so its image is turned round here: x' = -x and u' = 319 -
u. Its skeletons are in a right-handed frame all the same (x to the sensor's left, y up, z
forwards), so that OpenCV's frame is a half turn about z away: x' = -x, y' = -y, z' = z.
"""

import logging
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_runtime.pixels import encode_depth
from inhand_schemas.conventions import KINECT_V1
from inhand_schemas.joints import JOINT_NAMES
from inhand_schemas.messages import CameraInfo, Message, RgbdFrame
from inhand_tracker.geometry.arrays import Array
from numpy.typing import NDArray

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.importers.matlab import read_mat
from inhand_lab.importers.messages import imported_skeletons
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.sources import NobodyError, find_files, read_files, without_zeros
from inhand_lab.importers.timing import Timing, thin

SKELETON_SUFFIX = "_skeleton.mat"
DEPTH_SUFFIX = "_depth.mat"
log = logging.getLogger(__name__)

RECORDED_RATE = 30.0
WIDTH, HEIGHT = 320, 240
FOCAL_LENGTH = 285.63
MIRRORED_CX = 160.0
CY = 120.0

ACTIONS = (
    "swipeLeft",
    "swipeRight",
    "wave",
    "clap",
    "throw",
    "crossArms",
    "shootBasketball",
    "drawX",
    "drawCircleClockwise",
    "drawCircleCounterClockwise",
    "drawTriangle",
    "bowl",
    "box",
    "baseballSwing",
    "tennisSwing",
    "armCurl",
    "tennisServe",
    "push",
    "knock",
    "catch",
    "pickUpAndThrow",
    "jog",
    "walk",
    "sitToStand",
    "standToSit",
    "lunge",
    "squat",
)
"""Interactions that the actions a1 to a27 mime, in this order."""

JOINT_ORDER = (
    "Head",
    "ShoulderCenter",
    "Spine",
    "HipCenter",
    "ShoulderLeft",
    "ElbowLeft",
    "WristLeft",
    "HandLeft",
    "ShoulderRight",
    "ElbowRight",
    "WristRight",
    "HandRight",
    "HipLeft",
    "KneeLeft",
    "AnkleLeft",
    "FootLeft",
    "HipRight",
    "KneeRight",
    "AnkleRight",
    "FootRight",
)
"""The joints as the files order them."""

_OUR_ORDER = [JOINT_ORDER.index(name) for name in JOINT_NAMES]
_CAMERA_FROM_KINECT = np.array([-1.0, -1.0, 1.0])
_STEM = re.compile(r"a(\d{1,2})_(s\d+)_t\d+")


@dataclass(frozen=True)
class UtdMhadTrial:
    """One person's one performance; ``joints_in_camera`` (T, 20, 3) in metres."""

    stem: str
    interaction: str
    participant: str
    joints_in_camera: Array
    depth_file: Path | None


def import_utd_mhad(
    sources: Sequence[Path], folder: Path, frame_rate: float = DEFAULT_IMPORT.frame_rate
) -> Dataset:
    """Import ``*_skeleton.mat`` files, or folders of them, without objects or labels.

    Files that cannot be read or show nobody are named and left out. ``*_depth.mat`` beside a
    skeleton comes with it; where it cannot be read the skeleton comes alone. The two
    are paired by index; where one is longer its last frames are left out, and ``dataset.toml`` says
    how many were in all. Raises DatasetError where all files are left out, or InhandError.
    """
    files = read_files(find_files(sources, SKELETON_SUFFIX), read_trial)
    timing = thin(sources[0], RECORDED_RATE, frame_rate)
    writer = DatasetWriter(folder)
    unpaired = 0
    for trial in files.recordings:
        joints, depth = trial.joints_in_camera, None
        if trial.depth_file is not None:
            depth = _depth_if_readable(trial.depth_file)
        if depth is not None:
            unpaired += abs(len(joints) - len(depth))
            paired = min(len(joints), len(depth))
            joints, depth = joints[:paired], depth[:paired]
        entry = DatasetEntry(
            file=f"recordings/{trial.stem}.mcap",
            interaction=trial.interaction,
            participant=trial.participant,
            frame_rate=timing.frame_rate,
        )
        writer.add_recording(entry, _messages(trial.stem, joints, depth, timing))
    files.report()
    return writer.finish({"importer": "utd-mhad", "unpaired_frames": unpaired})


def read_trial(path: Path) -> UtdMhadTrial:
    """Read one ``*_skeleton.mat``; raises DatasetError."""
    stem = path.name.removesuffix(SKELETON_SUFFIX)
    match = _STEM.fullmatch(stem)
    if match is None or not 1 <= int(match[1]) <= len(ACTIONS):
        raise DatasetError(f"{path} is not named as UTD-MHAD names files: a15_s1_t1_skeleton.mat")
    (skeletons,) = read_mat(path, "d_skel")
    if skeletons.ndim == 2:
        skeletons = skeletons[..., None]
    if skeletons.shape[:2] != (20, 3) or skeletons.shape[-1] == 0:
        raise DatasetError(f"{path}: d_skel is {skeletons.shape}, and should be (20, 3, frames)")
    joints = without_zeros(np.moveaxis(skeletons.astype(np.float64), -1, 0)[:, _OUR_ORDER])
    if not np.isfinite(joints).all(axis=2).any():
        raise NobodyError(f"{path} has no frame with a body: no joint is anywhere but at zero")
    depth_file = path.with_name(stem + DEPTH_SUFFIX)
    return UtdMhadTrial(
        stem,
        ACTIONS[int(match[1]) - 1],
        match[2],
        joints * _CAMERA_FROM_KINECT,
        depth_file if depth_file.exists() else None,
    )


def read_depth(path: Path) -> NDArray[np.uint16]:
    """Read the depth (T, 240, 320) in millimetres, as a camera sees it; raises DatasetError."""
    (depth,) = read_mat(path, "d_depth")
    if depth.ndim == 2:
        depth = depth[..., None]
    if depth.shape[:2] != (HEIGHT, WIDTH) or depth.shape[-1] == 0 or depth.dtype != np.uint16:
        raise DatasetError(
            f"{path}: d_depth is {depth.dtype} {depth.shape}, and should be uint16 "
            f"({HEIGHT}, {WIDTH}, frames)"
        )
    return np.moveaxis(depth, -1, 0)[:, :, ::-1]


def _depth_if_readable(path: Path) -> NDArray[np.uint16] | None:
    """Read a file of depth; a warning names one that cannot be read."""
    try:
        return read_depth(path)
    except DatasetError as error:
        log.warning("%s; its skeletons come without depth", error)
        return None


def _messages(
    stem: str, joints: Array, depth: NDArray[np.uint16] | None, timing: Timing
) -> Iterator[Message]:
    yield CameraInfo(
        sequence=0,
        time_ns=timing.time_ns(0),
        width=WIDTH,
        height=HEIGHT,
        fx=FOCAL_LENGTH,
        fy=FOCAL_LENGTH,
        cx=WIDTH - 1 - MIRRORED_CX,
        cy=CY,
        depth_scale=0.001,
        frame_rate=timing.frame_rate,
        has_colour=False,
        has_depth=depth is not None,
        description=f"Kinect of UTD-MHAD, {stem}",
    )
    for sequence, frame in enumerate(range(0, len(joints), timing.step)):
        time_ns = timing.time_ns(sequence)
        if depth is not None:
            image = encode_depth(depth[frame])
            yield RgbdFrame(sequence=sequence, time_ns=time_ns, depth=image)
        yield imported_skeletons(sequence, time_ns, joints[frame], KINECT_V1)
