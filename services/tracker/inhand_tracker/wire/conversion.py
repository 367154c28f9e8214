"""From messages to arrays: the joints of a person, the image of a frame."""

from collections.abc import Collection
from typing import Literal

import numpy as np
from inhand_runtime.pixels import decode_colour, decode_grey, decode_metres
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, Person, RgbdFrame

from inhand_tracker.body.skeleton import without_impossible
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import intrinsics_of
from inhand_tracker.geometry.image import Image

Need = Literal["edges", "depth", "colour"]
"""What a method can need of a frame: the luminance for edges, the depth, the colours."""


def joints_of(person: Person) -> Array:
    """Give a person's joints (20, 3) in the camera frame.

    Missing joints are NaN, and so are those that are farther away than any room, and all of a
    skeleton whose joints are all zero, which trackers write of nobody.
    """
    joints = np.array(person.joints)
    if not joints.any():
        return np.full(joints.shape, np.nan)
    joints[[state == "missing" for state in person.states]] = np.nan
    return without_impossible(joints)


def image_of(frame: RgbdFrame, info: CameraInfo, needs: Collection[Need]) -> Image | None:
    """Decode what is needed of a frame; None when it holds nothing of that.

    Raises MessageError for damaged pixels, and for more of them than the camera has.
    """
    grey = frame.colour if "edges" in needs else None
    colour = frame.colour if "colour" in needs else None
    depth = frame.depth if "depth" in needs else None
    for image in (grey, colour, depth):
        if image is not None and (image.width > info.width or image.height > info.height):
            raise MessageError(
                f"a frame of {image.width} × {image.height} pixels comes from a camera of "
                f"{info.width} × {info.height}"
            )
    size = grey or colour or depth
    if size is None:
        return None
    return Image(
        None if grey is None else decode_grey(grey),
        intrinsics_of(info).scaled_to(size.width, size.height),
        None if depth is None else decode_metres(depth, info.depth_scale),
        None if colour is None else decode_colour(colour),
    )
