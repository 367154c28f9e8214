"""Values that no camera has are refused by the contract: what computes with them would not end."""

from typing import Any

import msgspec
import pytest
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, ColourImage, DepthImage
from inhand_schemas.topics import INFO

USUAL = {
    "sequence": 0,
    "time_ns": 1,
    "width": 640,
    "height": 480,
    "fx": 525.0,
    "fy": 525.0,
    "cx": 319.5,
    "cy": 239.5,
}


def test_a_usual_camera_is_taken() -> None:
    info = CameraInfo(**USUAL)
    assert INFO.decode(INFO.encode(info)) == info


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("fx", 1e300),
        ("fx", 1.0),
        ("fy", 1e9),
        ("cx", -1e12),
        ("cy", 1e300),
        ("depth_scale", 1e6),
        ("depth_scale", 1e-30),
        ("frame_rate", 1e300),
        ("frame_rate", 1e-300),
    ],
)
def test_a_camera_that_cannot_be_is_refused(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=r"lens|principal|depth scale|frame rate"):
        CameraInfo(**{**USUAL, field: value})
    plain: dict[str, Any] = msgspec.to_builtins(CameraInfo(**USUAL)) | {field: value}
    with pytest.raises(MessageError):
        INFO.decode(msgspec.msgpack.encode(plain))


@pytest.mark.parametrize("kind", [ColourImage, DepthImage])
def test_a_picture_larger_than_any_sensor_is_refused(kind: Any) -> None:
    codec = "jpeg" if kind is ColourImage else "z16-zstd"
    kind(codec, 4096, 4096, b"")
    with pytest.raises(ValueError, match="larger than any camera"):
        kind(codec, 16384, 16384, b"")
    with pytest.raises(ValueError, match="larger than any camera"):
        CameraInfo(**{**USUAL, "width": 16384, "height": 16384, "fx": 9e3, "fy": 9e3})
