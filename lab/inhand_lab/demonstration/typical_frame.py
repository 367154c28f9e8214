"""Draws the frame of a demonstration whose vertex error is the median one."""

from pathlib import Path

import cv2
import numpy as np
from inhand_runtime.errors import InhandError
from inhand_runtime.pixels import decode_colour
from inhand_runtime.recording import read_recording
from inhand_schemas.messages import RgbdFrame, Skeletons
from inhand_schemas.topics import RGBD, SKELETONS
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.geometry.camera import intrinsics_of
from inhand_tracker.people.following import PersonFollower
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.wire.conversion import joints_of

from inhand_lab.datasets.recorded_frames import load_camera_info
from inhand_lab.demonstration.parameters import DEFAULT_DEMONSTRATION
from inhand_lab.demonstration.review import FrameName, Review
from inhand_lab.report.picture import TRACKED, TRUE, WHITE, picture_of


def draw_typical_frame(recording: Path, review: Review, shape: ObjectShape, path: Path) -> None:
    """Draw the skeleton and the true and the tracked object into a picture file."""
    order = order_from_median(review.vertex_errors_m)[: DEFAULT_DEMONSTRATION.picture_candidates]
    candidates = [review.frames[index] for index in order]
    errors = dict(zip(candidates, review.vertex_errors_m[order].tolist(), strict=True))
    name, frame, skeletons = _find_frame(recording, candidates)
    info = load_camera_info(recording, name.camera)
    if info is None or frame.colour is None:
        raise InhandError(f"{recording} holds no picture to draw on")
    picture = picture_of(decode_colour(frame.colour), intrinsics_of(info))
    person = PersonFollower().choose(skeletons.people, skeletons.time_ns)
    if person is not None:
        picture.draw_skeleton(joints_of(person))
    picture.write(f"vertex error {100 * errors[name]:.1f} cm", 0, WHITE)
    objects = (("true", review.labels, TRUE), ("tracked", review.poses, TRACKED))
    for line, (text, messages, colour) in enumerate(objects, start=1):
        pose = messages[name].camera_from_object
        if pose is not None:
            picture.draw_object(shape, pose, colour)
        picture.write(f"{text} {shape.name}", line, colour)
    if not cv2.imwrite(str(path), cv2.cvtColor(picture.pixels, cv2.COLOR_RGB2BGR)):
        raise InhandError(f"cannot write {path}")


def order_from_median(errors: Array) -> Indices:
    """Return the indices (S,) of errors (S,), that of the median first, then ever less typical."""
    order = np.argsort(errors)
    return order[np.argsort(np.abs(np.arange(len(order)) - len(order) // 2))]


def _find_frame(
    recording: Path, candidates: list[FrameName]
) -> tuple[FrameName, RgbdFrame, Skeletons]:
    """The first candidate that has both image and skeletons."""
    frames: dict[FrameName, RgbdFrame] = {}
    skeletons: dict[FrameName, Skeletons] = {}
    for sample in read_recording(recording, streams=(RGBD.stream, SKELETONS.stream)):
        name = FrameName(sample.name, sample.sequence)
        if name in candidates:
            message = sample.message()
            if isinstance(message, RgbdFrame):
                frames[name] = message
            elif isinstance(message, Skeletons):
                skeletons[name] = message
    for name in candidates:
        if name in frames and name in skeletons:
            return name, frames[name], skeletons[name]
    raise InhandError(f"{recording} holds no frame with both a picture and a pose")
