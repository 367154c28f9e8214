"""What a training recording would lack by a picture and its skeletons; pure functions of them."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from inhand_runtime.pixels import decode_depth, decode_grey
from inhand_schemas.joints import Joint
from inhand_schemas.messages import CameraInfo, Person, RgbdFrame, Skeletons
from inhand_tracker.geometry.camera import intrinsics_of
from inhand_tracker.wire.conversion import joints_of

from inhand_lab.new_recordings.parameters import DEFAULT_VIEW

_HANDS = {"right": Joint.HAND_RIGHT, "left": Joint.HAND_LEFT}


@dataclass(frozen=True)
class Lack:
    """Something that is missing: its ``kind``, one word, and a sentence with the mend."""

    kind: str
    text: str


def picture_lacks(frame: RgbdFrame) -> Iterator[Lack]:
    """Say what is missing in a frame's colour and depth; raises MessageError for damaged ones."""
    if frame.colour is None:
        yield Lack("colour", "There is no colour picture: labels are placed on it.")
    elif decode_grey(frame.colour).mean() < DEFAULT_VIEW.darkest_grey:
        yield Lack("light", "It is too dark: put on a light.")
    if frame.depth is None:
        yield Lack("depth", "There is no depth: poses will be less exact.")
    elif np.mean(decode_depth(frame.depth) > 0) < DEFAULT_VIEW.least_measured_share:
        yield Lack("depth", "Hardly any depth is measured: move off, or out of the sun.")


def people_lacks(skeletons: Skeletons, info: CameraInfo | None) -> Iterator[Lack]:
    """Say what is missing of the person; hands are looked for where the camera's info is known."""
    if not skeletons.people:
        yield Lack("person", "Nobody is in view.")
    elif len(skeletons.people) > 1:
        number = len(skeletons.people)
        yield Lack("people", f"{number} people are in view: only one should be.")
    else:
        for side in _HANDS:
            if (text := _hand_lack(skeletons.people[0], side, info)) is not None:
                yield Lack(f"{side} hand", text)


def _hand_lack(person: Person, side: str, info: CameraInfo | None) -> str | None:
    hand = joints_of(person)[_HANDS[side]]
    if not np.isfinite(hand).all():
        return f"The {side} hand is not seen."
    if info is None:
        return None
    margin = DEFAULT_VIEW.edge_share * info.width
    pixel = intrinsics_of(info).project(hand)
    size = np.array([info.width, info.height])
    if not ((pixel >= 0.0) & (pixel <= size - 1.0)).all():
        return f"The {side} hand is out of the picture, and so is what it holds."
    if ((pixel < margin) | (pixel > size - 1.0 - margin)).any():
        return f"The {side} hand is at the edge of the picture: step to its middle, or back."
    return None
