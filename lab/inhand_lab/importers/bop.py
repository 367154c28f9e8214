"""Imports BOP data sets: images of still objects with true poses, and no people.

The camera is OpenCV's there as here, so a label's rotation is ``cam_R_m2c``, and its translation
``cam_t_m2c`` in metres. BOP has no times: image n is taken to be the n-th at 30 Hz.
"""

import logging
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path

import msgspec
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_schemas.messages import CameraInfo, Message, RgbdFrame

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.importers.bop_images import grey_bits, read_bop_pixels
from inhand_lab.importers.bop_models import find_models_folder, read_bop_shape
from inhand_lab.importers.bop_scenes import BopCamera, BopFrame, BopScene, read_scenes
from inhand_lab.importers.images import first_readable
from inhand_lab.importers.messages import imported_label
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.timing import Timing, thin
from inhand_lab.importers.ycb_video import INTERACTION, PARTICIPANT

log = logging.getLogger(__name__)

ASSUMED_RATE = 30.0


@dataclass(frozen=True)
class _Take:
    """The frames of a scene that one camera took, and the file that they make."""

    scene: BopScene
    file: str
    camera: BopCamera
    frames: tuple[BopFrame, ...]

    @cached_property
    def grey_bits(self) -> int:
        """Number of bits that the colour's pixels use."""
        return grey_bits(self.frames)


def import_bop(
    sources: Sequence[Path], folder: Path, frame_rate: float = DEFAULT_IMPORT.frame_rate
) -> Dataset:
    """Import data sets, splits or scenes as images and labels, one recording a scene and camera.

    A scene whose ``cam_K`` or ``depth_scale`` changes becomes a recording for each of them. The
    entry names the object where the recording labels one only. Raises DatasetError or InhandError.
    """
    timing = thin(sources[0], ASSUMED_RATE, frame_rate)
    scenes = [scene for source in sources for scene in read_scenes(source)]
    takes = [take for scene in scenes for take in _takes(scene, timing.step)]
    models = _models_folder(scenes)
    _refuse_same_files(takes)
    infos = [_camera_info(take, timing) for take in takes]
    writer = DatasetWriter(folder)
    _add_shapes(writer, models, takes)
    for take, info in zip(takes, infos, strict=True):
        names = {label.name for frame in take.frames for label in frame.labels}
        entry = DatasetEntry(
            file=take.file,
            interaction=INTERACTION,
            participant=PARTICIPANT,
            object=names.pop() if len(names) == 1 else None,
            frame_rate=timing.frame_rate,
        )
        writer.add_recording(entry, _messages(take, info, timing))
    return writer.finish({"importer": "bop"})


def _takes(scene: BopScene, step: int) -> list[_Take]:
    """Group every ``step``-th frame by camera; numbers count from the scene's first."""
    first = scene.frames[0].number
    by_camera: dict[BopCamera, list[BopFrame]] = {}
    for frame in scene.frames:
        if (frame.number - first) % step == 0:
            counted = replace(frame, number=(frame.number - first) // step)
            by_camera.setdefault(frame.camera, []).append(counted)
    return [
        _Take(
            scene,
            f"recordings/{scene.name}{f'_camera{index}' if index > 1 else ''}.mcap",
            camera,
            tuple(frames),
        )
        for index, (camera, frames) in enumerate(by_camera.items(), start=1)
    ]


def _models_folder(scenes: Sequence[BopScene]) -> Path | None:
    folders = {find_models_folder(scene.folder) for scene in scenes}
    if len(folders) > 1:
        named = sorted("no models" if one is None else str(one) for one in folders)
        raise DatasetError(
            f"the sources are of {len(folders)} data sets ({', '.join(named)}), whose objects have "
            "the same names: import them into several datasets"
        )
    return folders.pop()


def _refuse_same_files(takes: Sequence[_Take]) -> None:
    scenes: dict[str, Path] = {}
    for take in takes:
        if scenes.setdefault(take.file, take.scene.folder) != take.scene.folder:
            raise DatasetError(
                f"{scenes[take.file]} and {take.scene.folder} would be the same recording: rename "
                "one"
            )


def _add_shapes(writer: DatasetWriter, models: Path | None, takes: Sequence[_Take]) -> None:
    """Write each labelled object's shape, another one for each further instance of it."""
    labels = {
        label.name: label.object_id
        for take in takes
        for frame in take.frames
        for label in frame.labels
    }
    shapes = {
        number: None if models is None else read_bop_shape(models, number)
        for number in sorted(set(labels.values()))
    }
    without = [str(number) for number, shape in shapes.items() if shape is None]
    if without:
        log.warning(
            "no models/obj_….ply of the objects %s: their labels come without a mesh",
            ", ".join(without),
        )
    for name, number in labels.items():
        shape = shapes[number]
        if shape is not None:
            writer.add_shape(replace(shape, name=name))


def _messages(take: _Take, info: CameraInfo, timing: Timing) -> Iterator[Message]:
    yield info
    for frame in take.frames:
        time_ns = timing.time_ns(frame.number)
        try:
            colour, depth = read_bop_pixels(frame, take.grey_bits)
        except DatasetError as error:
            log.warning("%s; the frame is left out", error)
            continue
        yield RgbdFrame(
            sequence=frame.number,
            time_ns=time_ns,
            colour=None if colour is None else encode_colour(colour),
            depth=None if depth is None else encode_depth(depth),
        )
        for label in frame.labels:
            message = imported_label(
                frame.number, time_ns, label.name, label.translation, label.rotation
            )
            yield msgspec.structs.replace(message, visible_fraction=label.visible_fraction)


def _camera_info(take: _Take, timing: Timing) -> CameraInfo:
    camera = take.camera
    colour, depth = first_readable(take.frames, partial(read_bop_pixels, grey_bits=take.grey_bits))
    height, width = next(one.shape[:2] for one in (colour, depth) if one is not None)
    try:
        return CameraInfo(
            sequence=0,
            time_ns=timing.time_ns(0),
            width=width,
            height=height,
            fx=camera.fx,
            fy=camera.fy,
            cx=camera.cx,
            cy=camera.cy,
            depth_scale=camera.depth_scale,
            frame_rate=timing.frame_rate,
            has_colour=any(frame.colour is not None for frame in take.frames),
            has_depth=any(frame.depth is not None for frame in take.frames),
            description=f"camera of BOP, {take.scene.name}",
        )
    except ValueError as error:
        raise DatasetError(f"{take.scene.folder}: {error}") from None
