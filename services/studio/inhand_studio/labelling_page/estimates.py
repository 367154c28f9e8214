"""What a tracker says of the object in a frame, for a person who corrects it."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.keyframes import LabellingError
from inhand_lab.labelling.scene import load_scene
from inhand_lab.labelling.suggestions import (
    Suggestions,
    recorded_suggestions,
    tracked_suggestions,
)
from inhand_schemas.topics import POSE
from inhand_tracker.model.model import Model
from inhand_tracker.model.model_file import load_model

from inhand_studio.labelling_page.background import Advance
from inhand_studio.labelling_page.opened import OpenedRecording

FOLLOWED = 150
"""Frames before the one that is asked for from which on a model follows the object."""


def recorded_estimate(recording: OpenedRecording, name: str, frame: int) -> tuple[Pose, float]:
    """Return what a tracker said while it was recorded, and its confidence; raises LabellingError
    where it said nothing of this frame."""
    return _at(recorded_suggestions(recording.frames, name, frame, frame), frame)


def has_estimates(recording: OpenedRecording, name: str) -> bool:
    """Whether a tracker's estimates of an object were recorded."""
    return len(recording.frames.messages(POSE.stream, name)) > 0


def model_of(name: str, models: Sequence[Path]) -> Model:
    """Return the first model of an object; raises LabellingError where there is none, and
    ModelError for one that cannot be read."""
    for path in models:
        model = load_model(path)
        if model.shape.name == name:
            return model
    raise LabellingError(
        f"no tracker's estimates of {name} were recorded, and there is no model of it: train one "
        "on what is labelled so far"
    )


def tracked_estimate(
    path: Path, camera: str, model: Model, frame: int, advance: Advance, *, left_handed: bool
) -> tuple[Pose, float]:
    """Follow the object with a model for some seconds up to a frame, and return its pose and the
    confidence; raises LabellingError where the tracker has none, and RecordingError."""
    first = max(0, frame - FOLLOWED)
    said = tracked_suggestions(
        load_scene(path, camera),
        model,
        first,
        frame,
        left_handed=left_handed,
        on_frame=lambda number: advance((number - first) / max(frame - first, 1)),
    )
    return _at(said, frame)


def _at(said: Suggestions, frame: int) -> tuple[Pose, float]:
    index = frame - said.first
    if not said.given[index]:
        raise LabellingError("the tracker has no pose of the object in this frame")
    pose = np.asarray(said.translations[index]), np.asarray(said.rotations[index])
    return pose, float(said.confidences[index])
