"""Keyframes: the poses that a person gave of one object in one recording, and the file of them."""

import contextlib
import os
from collections import Counter
from pathlib import Path
from typing import Annotated

import msgspec
import numpy as np
from inhand_runtime.errors import InhandError
from inhand_schemas.messages import Pose
from inhand_tracker.body.anchors import ANCHORS
from inhand_tracker.geometry.arrays import Array
from msgspec import Meta, Struct

FORMAT = "inhand-keyframes"
VERSION = 1

Count = Annotated[int, Meta(ge=0)]


class LabellingError(InhandError):
    """Something cannot be labelled; the message says the mend."""


class Keyframe(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What a person said of one frame: the object's pose, or, with None, that it is absent.

    ``frame`` counts the camera's skeletons from 0, and ``time_ns`` is that frame's.
    ``camera_from_object`` is in metres. ``relative_to`` names the body part (``ANCHORS``) that the
    object moves with until the next keyframe; None stands for the camera.
    """

    frame: Count
    time_ns: int
    camera_from_object: Pose | None = None
    relative_to: str | None = None

    def __post_init__(self) -> None:
        if self.relative_to is not None and self.relative_to not in ANCHORS:
            raise ValueError(
                f"frame {self.frame} is relative to {self.relative_to!r}: choose one of "
                f"{', '.join(ANCHORS)}"
            )

    @property
    def pose(self) -> tuple[Array, Array] | None:
        """The translation (3,) and rotation (4,) camera_from_object, or None."""
        if self.camera_from_object is None:
            return None
        pose = self.camera_from_object
        return np.array(pose.translation), np.array(pose.rotation)


class KeyframeFile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """All keyframes of one object in one camera of one recording, in the order of their frames."""

    format: str = FORMAT
    version: int = VERSION
    recording: str
    object: str
    camera: str
    keyframes: tuple[Keyframe, ...]

    def __post_init__(self) -> None:
        frames = Counter(one.frame for one in self.keyframes)
        if twice := [frame for frame, count in frames.items() if count > 1]:
            raise ValueError(f"frame {min(twice)} has {frames[min(twice)]} keyframes: keep one")


def load_keyframes(path: Path) -> KeyframeFile:
    """Read a file of keyframes, sorted by frame; raises LabellingError."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise LabellingError(f"cannot read {path}: {error.strerror}; check the path") from None
    try:
        identity = msgspec.json.decode(data)
        if not isinstance(identity, dict) or identity.get("format") != FORMAT:
            raise LabellingError(f"{path} holds no keyframes: give a file of {FORMAT}")
        if identity.get("version") != VERSION:
            raise LabellingError(
                f"{path} is {FORMAT} version {identity.get('version')}, and this release reads "
                f"version {VERSION}"
            )
        contents = msgspec.convert(identity, KeyframeFile)
    except msgspec.ValidationError as error:
        raise LabellingError(f"{path}: {error}") from None
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise LabellingError(f"{path} is no whole JSON: {error}; take an older copy") from None
    in_order = sorted(contents.keyframes, key=lambda one: one.frame)
    return msgspec.structs.replace(contents, keyframes=tuple(in_order))


def save_keyframes(path: Path, contents: KeyframeFile) -> None:
    """Write a file of keyframes; what is there is replaced when all is on the disk, so that a crash
    leaves one or the other. Raises LabellingError."""
    data = msgspec.json.format(msgspec.json.encode(contents), indent=2)
    part = path.with_name(path.name + ".part")
    try:
        with part.open("wb") as file:
            file.write(data + b"\n")
            file.flush()
            os.fsync(file.fileno())
        part.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):
            part.unlink()
        raise LabellingError(
            f"cannot write {path}: {error.strerror}; make room or choose another file"
        ) from None
