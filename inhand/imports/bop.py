"""Scenes of the BOP benchmark: colour or grey, depth, true poses as labels, and the models."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import msgspec
import numpy as np
import simplejpeg
import trimesh
from inhand_lab.importers.bop_images import grey_bits, read_bop_colour, read_bop_depth
from inhand_lab.importers.bop_models import (
    bop_object_name,
    find_models_folder,
    read_bop_json,
    read_bop_mesh,
    read_bop_names,
)
from inhand_lab.importers.bop_scenes import (
    CAMERA_FILE,
    BopFrame,
    BopLabel,
    BopScene,
    find_camera_files,
    read_scene,
)
from inhand_lab.importers.messages import imported_label
from inhand_lab.importers.timing import Timing
from inhand_runtime.errors import InhandError
from inhand_runtime.pixels import decode_colour, encode_colour, encode_depth
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, ColourImage, ObjectPose, RgbdFrame
from inhand_schemas.topics import INFO, LABEL, RGBD
from trimesh.exchange.ply import export_ply

from inhand.exports.bop import TIMES_FILE
from inhand.imports.foreign import ForeignMessage, LeftOut

ASSUMED_RATE = 30.0
"""Rate in Hz at which images are taken to be recorded where nothing says when they were."""
_CAMERA_FILE = re.compile(rf"{CAMERA_FILE}\w*\.json")


@dataclass
class BopRecording:
    """A scene as it is imported, the frames' times in nanoseconds and the rate in Hz.

    ``assumed`` says whether nothing but the rate tells the times; ``models`` is the folder of its
    models, None without any, and ``names`` has those of the objects by number. ``grey_bits`` is the
    number of bits that the colour's pixels use. ``left_out`` counts frames that cannot be read.
    """

    scene: BopScene
    times_ns: tuple[int, ...]
    frame_rate: float
    assumed: bool
    models: Path | None
    names: Mapping[int, str]
    grey_bits: int
    left_out: LeftOut = field(default_factory=LeftOut)

    @property
    def objects(self) -> dict[str, int]:
        """The labelled objects' names, and their numbers in BOP."""
        labels = [label for frame in self.scene.frames for label in frame.labels]
        return {self.name_of(label): label.object_id for label in labels}

    def name_of(self, label: BopLabel) -> str:
        """Return the name of an object, which ends in ``_2`` of its second instance in a frame."""
        generic = bop_object_name(label.object_id)
        return self.names.get(label.object_id, generic) + label.name.removeprefix(generic)

    def meshes(self) -> dict[str, bytes]:
        """Return the labelled objects' meshes, PLY in metres by name, as far as there are any.

        Raises InhandError for one that cannot be used.
        """
        if self.models is None:
            return {}
        found = {}
        for name, number in self.objects.items():
            mesh = read_bop_mesh(self.models, number)
            if mesh is not None:
                found[name] = export_ply(trimesh.Trimesh(*mesh, process=False))
        return found

    def messages(self, camera: str) -> Iterator[ForeignMessage]:
        """Yield the camera's info, its frames and the labels; raises InhandError where no frame can
        be read."""
        begun = False
        for number, (time_ns, frame) in enumerate(
            zip(self.times_ns, self.scene.frames, strict=True)
        ):
            try:
                message = self._frame(number, time_ns, frame)
            except InhandError as error:
                self.left_out.add(str(error))
                continue
            if not begun:
                yield ForeignMessage(INFO, camera, self._info(time_ns, message), time_ns)
                begun = True
            yield ForeignMessage(RGBD, camera, message, time_ns)
            for label in frame.labels:
                name = self.name_of(label)
                pose = self._label(number, time_ns, camera, label)
                yield ForeignMessage(LABEL, name, pose, time_ns)
        if not begun:
            raise InhandError(f"no frame of it can be read: {self.left_out.reason}")

    def _frame(self, number: int, time_ns: int, frame: BopFrame) -> RgbdFrame:
        colour = None if frame.colour is None else self._colour(frame.colour)
        depth = None if frame.depth is None else encode_depth(read_bop_depth(frame.depth))
        if colour and depth and (colour.width, colour.height) != (depth.width, depth.height):
            raise InhandError(
                f"{frame.depth} is {depth.width} × {depth.height}, and {frame.colour} "
                f"{colour.width} × {colour.height}: they should be aligned"
            )
        return RgbdFrame(sequence=number, time_ns=time_ns, colour=colour, depth=depth)

    def _colour(self, path: Path) -> ColourImage:
        """Read an image; a JPEG stays as it is."""
        try:
            data = path.read_bytes()
        except OSError as error:
            raise InhandError(f"cannot read {path}: {error.strerror}") from None
        if not simplejpeg.is_jpeg(data):
            return encode_colour(read_bop_colour(path, self.grey_bits))
        try:
            height, width, *_ = simplejpeg.decode_jpeg_header(data)
            image = ColourImage("jpeg", width, height, data)
            decode_colour(image)
        except (ValueError, MessageError) as error:
            raise InhandError(f"{path}: {error}") from None
        return image

    def _label(self, number: int, time_ns: int, camera: str, label: BopLabel) -> ObjectPose:
        name = self.name_of(label)
        pose = imported_label(number, time_ns, name, label.translation, label.rotation)
        visible = label.visible_fraction
        return msgspec.structs.replace(pose, camera=camera, visible_fraction=visible)

    def _info(self, time_ns: int, frame: RgbdFrame) -> CameraInfo:
        image = frame.colour or frame.depth
        assert image is not None  # a frame of a scene has one of them
        lens, frames = self.scene.frames[0].camera, self.scene.frames
        try:
            return CameraInfo(
                sequence=0,
                time_ns=time_ns,
                width=image.width,
                height=image.height,
                fx=lens.fx,
                fy=lens.fy,
                cx=lens.cx,
                cy=lens.cy,
                depth_scale=lens.depth_scale,
                frame_rate=self.frame_rate,
                has_colour=any(one.colour is not None for one in frames),
                has_depth=any(one.depth is not None for one in frames),
                description=f"camera of BOP, {self.scene.name}",
            )
        except ValueError as error:
            raise InhandError(f"{self.scene.folder}: {error}") from None


def read_bop(source: Path, frame_rate: float | None = None) -> BopRecording:
    """Read a scene's files, and no images but grey ones of 16 bits.

    ``source`` is the folder of a scene, or one that holds no other scene, or a scene's
    ``scene_camera….json`` of one of several sensors. The times are those of ``scene_times.json``,
    which our exports have; without it, or with a ``frame_rate``, image n is the n-th at that rate.
    Raises InhandError for what is no scene, is damaged, or has several cameras.
    """
    scene = read_scene(_camera_file(source))
    if len(cameras := {frame.camera for frame in scene.frames}) > 1:
        raise InhandError(
            f"{scene.folder} has {len(cameras)} cameras, by cam_K and depth_scale, and a recording "
            "one: `inhand import bop` makes a dataset with a recording of each"
        )
    models = find_models_folder(scene.folder)
    times_file = scene.folder / TIMES_FILE
    assumed = frame_rate is not None or not times_file.is_file()
    if assumed:
        rate = ASSUMED_RATE if frame_rate is None else frame_rate
        first, timing = scene.frames[0].number, Timing(rate, 1)
        times = [timing.time_ns(frame.number - first) for frame in scene.frames]
    else:
        times = _recorded_times(times_file, scene.frames)
        steps = np.diff(times)
        rate = float(1e9 / np.median(steps)) if len(steps) else ASSUMED_RATE
    return BopRecording(
        scene=scene,
        times_ns=tuple(times),
        frame_rate=rate,
        assumed=assumed,
        models=models,
        names={} if models is None else read_bop_names(models),
        grey_bits=grey_bits(scene.frames),
    )


def _camera_file(source: Path) -> Path:
    if source.is_file() and _CAMERA_FILE.fullmatch(source.name):
        return source
    files = find_camera_files(source) if source.is_dir() else []
    if not files:
        raise InhandError(
            f"{source} is no scene of BOP: name a folder that has {CAMERA_FILE}.json, as "
            "test/000001 of a data set"
        )
    if len(files) > 1:
        shown = ", ".join(str(path.relative_to(source)) for path in files[:3])
        raise InhandError(
            f"{source} has {len(files)} scenes or sensors: name one, of {shown}"
            + (", …" if len(files) > 3 else "")
        )
    return files[0]


def _recorded_times(path: Path, frames: Sequence[BopFrame]) -> list[int]:
    recorded = read_bop_json(path, dict[int, int])
    missing = [frame.number for frame in frames if frame.number not in recorded]
    if missing:
        raise InhandError(f"{path} has no image {missing[0]}: --frame-rate HZ goes without it")
    times = [recorded[frame.number] for frame in frames]
    if min(times) < 0 or not (np.diff(times) > 0).all():
        raise InhandError(
            f"{path}: times must rise from image to image: --frame-rate HZ goes without them"
        )
    return times
