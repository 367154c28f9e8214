"""What a tracker says of an object in each frame, as labels that a person corrects.

It is what a tracker said while the recording was made (``pose/OBJECT``), or what a model says of
it now.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from inhand_runtime.recording import SEQUENCE_MASK
from inhand_schemas.errors import MessageError
from inhand_schemas.topics import POSE
from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.methods.registry import DEFAULT_METHOD, METHODS, new_tracker
from inhand_tracker.model.model import Model

from inhand_lab.datasets.frame_index import FrameIndex, FrameStamp, open_frames
from inhand_lab.datasets.frame_pixels import FrameMatcher
from inhand_lab.labelling.keyframes import LabellingError
from inhand_lab.labelling.scene import Scene
from inhand_lab.labelling.stretch_views import image_at


@dataclass(frozen=True)
class Suggestions:
    """Poses camera_from_object of the frames ``first``, ``first + 1``, …, T in all: (T, 3) and
    (T, 4), NaN where the tracker had none, and its confidence (T,), 0 there.

    The confidence is the probability that the true pose is within 10 cm and 30°.
    """

    first: int
    translations: Array
    rotations: Array
    confidences: Array

    @property
    def given(self) -> Flags:
        """Flags (T,) of the frames that have a pose."""
        return np.isfinite(self.translations[:, 0])

    def put(self, frame: int, pose: tuple[Array, Array], confidence: float) -> None:
        """Note the pose of a frame of the recording."""
        index = frame - self.first
        self.translations[index], self.rotations[index] = pose
        self.confidences[index] = confidence


def recorded_suggestions(
    frames: FrameIndex, object_name: str, first: int, last: int
) -> Suggestions:
    """Read what a tracker said of an object in frames ``first`` to ``last`` while they were taken.

    Estimates by another camera are left out. Raises RecordingError, and LabellingError where there
    are none at all.
    """
    recorded = frames.messages(POSE.stream, object_name)
    if not len(recorded):
        raise LabellingError(
            f"{frames.path} holds no estimates of {object_name}: record with a tracker of it, or "
            "take those of a model"
        )
    suggestions, matcher = _nothing(first, last), FrameMatcher(frames.stamps[first : last + 1])
    margin_ns = int(np.median(np.diff(frames.times_ns))) if len(frames) > 1 else 0
    captured = recorded.stamps.captured_ns
    span = frames.times_ns[first] - margin_ns, frames.times_ns[last] + margin_ns
    for number in np.flatnonzero((captured >= span[0]) & (captured <= span[1])).tolist():
        with suppress(MessageError):  # one that cannot be read says nothing of its frame
            estimate = POSE.decode(recorded[number].payload)
            stamp = FrameStamp(estimate.sequence & SEQUENCE_MASK, estimate.time_ns)
            frame = matcher.match(stamp) if estimate.camera == frames.camera else None
            pose = estimate.camera_from_object
            if frame is not None and pose is not None:
                arrays = np.array(pose.translation), np.array(pose.rotation)
                suggestions.put(first + frame, arrays, estimate.confidence)
    return suggestions


def tracked_suggestions(
    scene: Scene,
    model: Model,
    first: int,
    last: int,
    *,
    left_handed: bool = False,
    on_frame: Callable[[int], None] = lambda _: None,
) -> Suggestions:
    """Let a tracker with a model follow its object from frame ``first`` to ``last``.

    ``on_frame`` is called with the number of each frame when it is done; what it raises ends the
    work. Raises RecordingError, and ModelError for a model that cannot be used.
    """
    tracker = new_tracker(model, left_handed=left_handed)
    method = METHODS[DEFAULT_METHOD]
    needs, suggestions = method.needs(method.usual_terms), _nothing(first, last)
    before: int | None = None
    with open_frames(scene.path, scene.camera) as frames:
        tracker.convention = frames.skeletons(first).convention
        for frame in range(first, last + 1):
            person = scene.people[frame]
            if before is not None and person not in (None, before):
                tracker.restart()
            before = before if person is None else person
            joints = None if person is None else scene.joints[frame]
            image = image_at(scene, frames, frame, needs)
            estimate = tracker.step(joints, int(scene.times_ns[frame]), image)
            if estimate.translation is not None and estimate.rotation is not None:
                pose = estimate.translation, estimate.rotation
                suggestions.put(frame, pose, estimate.confidence)
            on_frame(frame)
    return suggestions


def _nothing(first: int, last: int) -> Suggestions:
    if not 0 <= first <= last:
        raise LabellingError(f"frames {first} to {last} are none: give the first one first")
    count = last + 1 - first
    return Suggestions(
        first, np.full((count, 3), np.nan), np.full((count, 4), np.nan), np.zeros(count)
    )
