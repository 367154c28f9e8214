"""Folders in the layout of the TUM RGB-D benchmark, the benchmark's own and those we exported."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from inhand_runtime.errors import InhandError
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_schemas.keys import require_name
from inhand_schemas.messages import CameraInfo, ColourImage, DepthImage, ObjectPose, RgbdFrame
from inhand_schemas.topics import INFO, LABEL, RGBD
from numpy.typing import NDArray

from inhand.imports.foreign import ForeignMessage
from inhand.imports.pairing import nearest_partners
from inhand.imports.tum_files import Truth, read_camera, read_images, read_truth


@dataclass(frozen=True)
class TumFolder:
    """A folder: times of images (N,) in nanoseconds and their paths, colour and depth apart, the
    camera, and the true poses of an object where there are any."""

    colour: dict[int, Path]
    depth: dict[int, Path]
    info: CameraInfo
    truth: Truth | None

    @property
    def frames(self) -> list[tuple[int, Path | None, Path | None, int]]:
        """Each frame's time, colour and depth, and how far apart these are in nanoseconds; depth
        that belongs to no colour is left out where there is any colour."""
        if not self.colour:
            return [(time_ns, None, path, 0) for time_ns, path in self.depth.items()]
        partners = nearest_partners(list(self.colour), list(self.depth))
        return [
            (time_ns, path, self.depth.get(other, None), abs(other - time_ns) if other >= 0 else 0)
            for (time_ns, path), other in zip(self.colour.items(), partners, strict=True)
        ]


def read_tum(folder: Path, object_name: str | None = None) -> TumFolder:
    """Read a folder's lists, and no images; raises InhandError for one that lacks what is needed.

    The poses of the benchmark's own are the camera's in its room: they are turned round, to where
    the room is in the camera, as an object ``world``, or ``object_name``.
    """
    if not folder.is_dir():
        raise InhandError(f"{folder} is no folder: name one with rgb.txt and depth.txt")
    images = {name: read_images(folder, f"{name}.txt") for name in ("rgb", "depth")}
    if not any(images.values()):
        raise InhandError(f"{folder} has neither rgb.txt nor depth.txt with an image")
    info = read_camera(folder, images["rgb"], images["depth"])
    return TumFolder(images["rgb"], images["depth"], info, read_truth(folder, object_name))


def messages_of(folder: TumFolder, camera: str) -> Iterator[ForeignMessage]:
    """Yield the camera's info, its frames, and the object's poses in them as labels.

    Raises InhandError for an image that is missing or damaged.
    """
    require_name("camera", camera)
    yield ForeignMessage(INFO, camera, folder.info, folder.info.time_ns)
    for number, (time_ns, colour, depth, apart_ns) in enumerate(folder.frames):
        frame = RgbdFrame(
            sequence=number,
            time_ns=time_ns,
            time_uncertainty_ns=apart_ns,
            colour=None if colour is None else _colour(colour),
            depth=None if depth is None else _depth(depth),
        )
        yield ForeignMessage(RGBD, camera, frame, time_ns)
        pose = None if folder.truth is None else folder.truth.at(time_ns)
        if folder.truth is not None and pose is not None:
            label = ObjectPose(
                sequence=number,
                time_ns=time_ns,
                object=folder.truth.object,
                camera=camera,
                state="tracked",
                confidence=1.0,
                camera_from_object=pose,
            )
            yield ForeignMessage(LABEL, folder.truth.object, label, time_ns)


def _colour(path: Path) -> ColourImage:
    pixels = _image(path, cv2.IMREAD_COLOR)
    return encode_colour(np.ascontiguousarray(pixels[..., ::-1]))


def _depth(path: Path) -> DepthImage:
    pixels = _image(path, cv2.IMREAD_UNCHANGED)
    if pixels.dtype != np.uint16 or pixels.ndim != 2:
        raise InhandError(f"{path} is no depth: that is one channel of 16 bits")
    return encode_depth(pixels)


def _image(path: Path, flags: int) -> NDArray[Any]:
    try:
        data = np.frombuffer(path.read_bytes(), np.uint8)
    except OSError as error:
        raise InhandError(f"cannot read {path}: {error.strerror}") from None
    pixels = cv2.imdecode(data, flags) if len(data) else None
    if pixels is None:
        raise InhandError(f"{path} is no image that can be read")
    return pixels
