"""Types of messages' fields with their bounds, and what else is asked of values."""

import math
from collections.abc import Iterable
from typing import Annotated, Literal

from msgspec import Meta

# Ends by a lookahead, since in some languages "$" also matches before a last newline.
NAME_PATTERN = r"^[a-z0-9_]+(?![\s\S])"

MOST_PEOPLE = 64
"""Number of people that a message holds at the most."""

Name = Annotated[str, Meta(pattern=NAME_PATTERN, max_length=64)]
Count = Annotated[int, Meta(ge=0, le=2**63 - 1)]
Nanoseconds = Annotated[int, Meta(ge=0, le=2**63 - 1)]
Pixels = Annotated[int, Meta(ge=1, le=16384)]
Positive = Annotated[float, Meta(gt=0)]
NonNegative = Annotated[float, Meta(ge=0)]
Fraction = Annotated[float, Meta(ge=0, le=1)]
FractionOrNaN = Annotated[float, Meta(extra_json_schema={"minimum": 0.0, "maximum": 1.0})]
"""Bounds that decoding does not ask for, since it would refuse a NaN: the struct has to."""
Vector3 = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
Text = Annotated[str, Meta(max_length=4096)]

ColourCodec = Literal["jpeg", "rgb8", "h264"]
DepthCodec = Literal["z16", "z16-zstd", "png16"]
JointState = Literal["missing", "inferred", "tracked"]
PoseState = Literal["tracked", "predicted", "lost"]
Contact = Literal["resting", "right_hand", "left_hand", "both_hands", "worn"]
ServiceState = Literal["starting", "running", "degraded", "stopping"]

UNIT_TOLERANCE = 1e-3
MOST_PIXELS = 1 << 24
"""Pixels of the largest picture: sensors have 12 million, and decoding takes memory by this."""
WIDEST_LENS, LONGEST_LENS = 0.05, 100.0
"""Bounds of the focal length, in image widths: beyond them no lens is, and every loop over what
it projects has no end."""


def require_finite(what: str, numbers: Iterable[float]) -> None:
    """Raise ValueError where one of the numbers is not finite."""
    if not all(map(math.isfinite, numbers)):
        raise ValueError(f"{what} holds a number that is not finite")


def require_pixels(width: int, height: int) -> None:
    """Raise ValueError for an image with more pixels than any camera's."""
    if width * height > MOST_PIXELS:
        raise ValueError(f"an image of {width} × {height} pixels is larger than any camera's")
