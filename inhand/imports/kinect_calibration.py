"""The factory's calibration of an Azure Kinect, and what it says of the modes of its cameras.

As ``calibration.c`` and ``mode_specific_calibration.c`` of the Azure Kinect Sensor SDK read it: the
centre and the focal lengths are shares of the sensor's size from its corner; an image is a part of
the sensor, perhaps with pixels put together.
"""

from typing import Literal

import msgspec
import numpy as np
from inhand_runtime.errors import InhandError
from inhand_schemas.messages import CameraInfo
from numpy.typing import NDArray

from inhand.imports.alignment import DepthAlignment, align_depth

DEPTH_SCALE = 0.001
"""Metres a unit of depth."""
_DEPTH_MODES = {
    (320, 288): (512, (96, 90)),
    (640, 576): (1024, (192, 180)),
    (512, 512): (512, (0, 0)),
    (1024, 1024): (1024, (0, 0)),
}
"""By an image's size: pixels along the whole sensor, and where the image begins in it."""
_COLOUR_MODES = (
    (1280, 720),
    (1920, 1080),
    (2560, 1440),
    (2048, 1536),
    (3840, 2160),
    (4096, 3072),
)
"""Sizes of images: all as wide as the sensor, which is 4 : 3, and cut above and below."""
_MODEL = "CALIBRATION_LensDistortionModelBrownConrady"
_PARAMETERS = 14
_UNIT_TOLERANCE = 1e-3
"""Deviation up to which a matrix is a rotation: the file has it with the digits of a float."""

Size = tuple[int, int]
Place = Literal["D0", "PV0"]
"""The depth camera and the colour camera, as the file names them."""


class _Lens(msgspec.Struct, frozen=True):
    parameters: tuple[float, ...] = msgspec.field(name="ModelParameters")
    model: str = msgspec.field(name="ModelType")


class _Motion(msgspec.Struct, frozen=True):
    rotation: tuple[float, ...] = msgspec.field(name="Rotation")
    translation: tuple[float, float, float] = msgspec.field(name="Translation")


class _Camera(msgspec.Struct, frozen=True):
    lens: _Lens = msgspec.field(name="Intrinsics")
    location: str = msgspec.field(name="Location")
    motion: _Motion = msgspec.field(name="Rt")
    width: int = msgspec.field(name="SensorWidth")
    height: int = msgspec.field(name="SensorHeight")


class _Cameras(msgspec.Struct, frozen=True):
    cameras: tuple[_Camera, ...] = msgspec.field(name="Cameras")


class _File(msgspec.Struct, frozen=True):
    information: _Cameras = msgspec.field(name="CalibrationInformation")


def aligned_views(
    data: bytes, colour: Size | None, depth: Size | None, time_ns: int, frame_rate: float
) -> tuple[CameraInfo, DepthAlignment | None]:
    """Return how the colour camera sees, or the depth camera where it is alone, and what makes its
    images the other's.

    ``colour`` and ``depth`` are the sizes of their images, None without any. Raises InhandError.
    """
    cameras = _read(data)
    of_depth = None if depth is None else _depth_info(cameras["D0"], depth, time_ns, frame_rate)
    if colour is None:
        assert of_depth is not None  # there is one of them
        return msgspec.structs.replace(of_depth, has_colour=False), None
    of_colour = _colour_info(cameras["PV0"], colour, time_ns, frame_rate)
    if of_depth is None:
        return msgspec.structs.replace(of_colour, has_depth=False), None
    turn, shift = _motion(cameras["PV0"])
    depth_turn, depth_shift = _motion(cameras["D0"])
    turn = turn @ depth_turn.T
    return of_colour, align_depth(of_depth, of_colour, turn, shift - turn @ depth_shift)


def _read(data: bytes) -> dict[Place, _Camera]:
    try:
        file = msgspec.json.decode(data.rstrip(b"\0"), type=_File)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise InhandError(f"it is not as the SDK has it: {error}") from None
    found: dict[Place, _Camera] = {}
    places: tuple[Place, Place] = ("D0", "PV0")
    for place in places:
        named = [
            one
            for one in file.information.cameras
            if one.location == f"CALIBRATION_CameraLocation{place}"
        ]
        if not named:
            raise InhandError(f"it has no camera {place}")
        found[place] = named[0]
    return found


def _depth_info(camera: _Camera, size: Size, time_ns: int, frame_rate: float) -> CameraInfo:
    if size not in _DEPTH_MODES or (camera.width, camera.height) != (1024, 1024):
        raise InhandError(f"no mode of the depth camera has images of {size[0]} × {size[1]}")
    along, begin = _DEPTH_MODES[size]
    return _info(camera, (along, along), begin, size, time_ns, frame_rate)


def _colour_info(camera: _Camera, size: Size, time_ns: int, frame_rate: float) -> CameraInfo:
    width, height = size
    if size not in _COLOUR_MODES:
        raise InhandError(f"no mode of the colour camera has images of {width} × {height}")
    # An early calibration is of the sensor's part of 16 : 9.
    whole = width * 9 // 16 if camera.width * 9 == camera.height * 16 else width * 3 // 4
    if camera.width * whole != camera.height * width:
        raise InhandError(f"the colour camera has a sensor of {camera.width} × {camera.height}")
    cut = (whole - height) // 2
    return _info(camera, (width, whole), (0, cut), size, time_ns, frame_rate)


def _info(
    camera: _Camera, along: Size, begin: Size, size: Size, time_ns: int, frame_rate: float
) -> CameraInfo:
    numbers = camera.lens.parameters
    if camera.lens.model != _MODEL or len(numbers) < _PARAMETERS:
        raise InhandError(f"a lens of the model {camera.lens.model!r} is not read, only {_MODEL}")
    cx, cy, fx, fy, k1, k2, k3, k4, k5, k6, _, _, p2, p1 = numbers[:_PARAMETERS]
    try:
        return CameraInfo(
            sequence=0,
            time_ns=time_ns,
            width=size[0],
            height=size[1],
            fx=fx * along[0],
            fy=fy * along[1],
            # From the sensor's corner to the middle of the image's first pixel.
            cx=cx * along[0] - begin[0] - 0.5,
            cy=cy * along[1] - begin[1] - 0.5,
            distortion=(k1, k2, p1, p2, k3, k4, k5, k6),
            depth_scale=DEPTH_SCALE,
            frame_rate=frame_rate,
            description="Azure Kinect",
        )
    except ValueError as error:
        raise InhandError(str(error)) from None


def _motion(camera: _Camera) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the rotation (3, 3) and the translation (3,) in metres to a camera."""
    matrix = np.array(camera.motion.rotation)
    if matrix.shape != (9,):
        raise InhandError("a rotation is not 9 numbers")
    rotation = matrix.reshape(3, 3)
    if np.abs(rotation @ rotation.T - np.eye(3)).max() > _UNIT_TOLERANCE:
        raise InhandError("a rotation is none")
    return rotation, np.array(camera.motion.translation)
