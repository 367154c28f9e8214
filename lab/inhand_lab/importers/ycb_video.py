"""Imports YCB-Video: a moving RGB-D camera and still objects with true poses (Xiang et al. 2017).

A source is the data set's folder, or an excerpt of it: ``data/0000/000001-color.png`` and
``-depth.png`` (uint16), aligned; the poses as ``ycb_annotations`` finds them, the objects' shapes
as ``ycb_shapes`` does.
"""

import logging
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_schemas.messages import CameraInfo, Message, RgbdFrame
from numpy.typing import NDArray

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.importers.images import first_readable, read_image
from inhand_lab.importers.messages import imported_label
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.timing import Timing, thin
from inhand_lab.importers.ycb_annotations import Annotation, read_annotation, read_poses_file
from inhand_lab.importers.ycb_shapes import find_shape

log = logging.getLogger(__name__)

RECORDED_RATE = 30.0
COLOUR_SUFFIX = "-color.png"
DEPTH_SUFFIX = "-depth.png"
INTERACTION = "none"
PARTICIPANT = "nobody"


@dataclass(frozen=True)
class Clip:
    """One video; ``frames`` are paths without their endings, ``numbers`` count from the first."""

    folder: Path
    frames: tuple[Path, ...]
    numbers: tuple[int, ...]
    annotations: tuple[Annotation, ...]


def import_ycb_video(
    sources: Sequence[Path], folder: Path, frame_rate: float = DEFAULT_IMPORT.frame_rate
) -> Dataset:
    """Import data-set folders as images and labels without people, one recording a video.

    A recording labels every object of its video, each on a topic of its own, so that its entry
    names none. Raises DatasetError or InhandError.
    """
    timing = thin(sources[0], RECORDED_RATE, frame_rate)
    clips = [clip for root in sources for clip in read_clips(root, timing.step)]
    infos = [_camera_info(clip, timing) for clip in clips]
    writer = DatasetWriter(folder)
    for clip, info in zip(clips, infos, strict=True):
        for name in dict.fromkeys(n for a in clip.annotations for n in a.camera_from_objects):
            shape = find_shape(name, clip.folder.parent.parent, clip.frames)
            if shape is not None:
                writer.add_shape(shape)
        entry = DatasetEntry(
            file=f"recordings/{clip.folder.name}.mcap",
            interaction=INTERACTION,
            participant=PARTICIPANT,
            frame_rate=timing.frame_rate,
        )
        writer.add_recording(entry, _messages(clip, info, timing))
    return writer.finish({"importer": "ycb-video"})


def read_clips(root: Path, step: int = 1) -> list[Clip]:
    """Read the videos of a data-set folder, every ``step``-th frame; raises DatasetError."""
    folders = sorted({path.parent for path in root.glob(f"data/*/*{COLOUR_SUFFIX}")})
    if not folders:
        raise DatasetError(
            f"{root} holds no data/0000/000001{COLOUR_SUFFIX}: name the folder of YCB-Video"
        )
    # The excerpt's file of poses does not say of which video a frame is.
    poses = read_poses_file(root) if len(folders) == 1 else {}
    clips = []
    for folder in folders:
        frames = _numbered_frames(folder)
        first = min(frames)
        kept = {n - first: path for n, path in frames.items() if (n - first) % step == 0}
        annotations = tuple(read_annotation(path, poses) for path in kept.values())
        numbers = tuple(number // step for number in kept)
        clips.append(Clip(folder, tuple(kept.values()), numbers, annotations))
    return clips


def read_colour(frame: Path) -> NDArray[Any]:
    """Read the RGB image (H, W, 3) of a frame; raises DatasetError."""
    return read_image(frame.with_name(frame.name + COLOUR_SUFFIX), cv2.IMREAD_COLOR_RGB)


def read_depth_units(frame: Path) -> NDArray[Any]:
    """Read the depth (H, W) of a frame in the data set's units; raises DatasetError."""
    return read_image(frame.with_name(frame.name + DEPTH_SUFFIX), cv2.IMREAD_UNCHANGED)


def _read_pixels(frame: Path) -> tuple[NDArray[Any], NDArray[Any]]:
    """Read a frame's colour and depth, which are aligned; raises DatasetError."""
    colour, depth = read_colour(frame), read_depth_units(frame)
    if depth.dtype != np.uint16 or depth.shape != colour.shape[:2]:
        raise DatasetError(
            f"{frame}{DEPTH_SUFFIX} is {depth.dtype} {depth.shape}, and should be uint16 "
            f"{colour.shape[:2]} as its colour image"
        )
    return colour, depth


def _numbered_frames(folder: Path) -> dict[int, Path]:
    frames = {}
    for path in sorted(folder.glob(f"*{COLOUR_SUFFIX}")):
        stem = path.name.removesuffix(COLOUR_SUFFIX)
        if not stem.isdecimal():
            raise DatasetError(f"{path} is not named by a frame's number: 000001{COLOUR_SUFFIX}")
        depth = path.with_name(stem + DEPTH_SUFFIX)
        if not depth.is_file():
            raise DatasetError(f"{depth} is missing beside {path.name}")
        frames[int(stem)] = path.with_name(stem)
    return frames


def _messages(clip: Clip, info: CameraInfo, timing: Timing) -> Iterator[Message]:
    yield info
    for number, path, annotation in zip(clip.numbers, clip.frames, clip.annotations, strict=True):
        time_ns = timing.time_ns(number)
        try:
            colour, depth = _read_pixels(path)
        except DatasetError as error:
            log.warning("%s; the frame is left out", error)
            continue
        yield RgbdFrame(
            sequence=number,
            time_ns=time_ns,
            colour=encode_colour(colour),
            depth=encode_depth(depth),
        )
        for name, (translation, rotation) in annotation.camera_from_objects.items():
            yield imported_label(number, time_ns, name, translation, rotation)


def _camera_info(clip: Clip, timing: Timing) -> CameraInfo:
    first = clip.annotations[0]
    colour, _ = first_readable(clip.frames, _read_pixels)
    height, width = colour.shape[:2]
    return CameraInfo(
        sequence=0,
        time_ns=timing.time_ns(0),
        width=width,
        height=height,
        fx=float(first.camera_matrix[0, 0]),
        fy=float(first.camera_matrix[1, 1]),
        cx=float(first.camera_matrix[0, 2]),
        cy=float(first.camera_matrix[1, 2]),
        depth_scale=1.0 / first.depth_divisor,
        frame_rate=timing.frame_rate,
        description=f"camera of YCB-Video, {clip.folder.name}",
    )
