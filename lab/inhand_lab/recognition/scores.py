"""How well an object that was not given was recognised and found, on one recording."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.recognition.recognition import Recognition

from inhand_lab.datasets.recorded_frames import RecordedFrame
from inhand_lab.datasets.tracks import Track, empty_track, true_track
from inhand_lab.evaluation.pose_errors import ErrorGauge
from inhand_lab.recognition.true_boxes import centres

UNKNOWN = -1


@dataclass(frozen=True)
class Answers:
    """What a method said of T frames: ``known`` (T,) actions, ``boxes`` (T, 4) and a pose of the
    object that is known."""

    known: Indices
    boxes: Array
    track: Track

    @classmethod
    def empty(cls, frames: int) -> "Answers":
        """Nothing said yet."""
        boxes = np.full((frames, 4), np.nan)
        return cls(np.full(frames, UNKNOWN, np.int64), boxes, empty_track(frames))

    def put(self, frame: int, recognition: Recognition) -> None:
        """Take the answer to one frame."""
        if recognition.known is not None:
            self.known[frame] = recognition.known
            self.track.put(frame, recognition.estimate)
        if recognition.box is not None:
            self.boxes[frame] = recognition.box


@dataclass(frozen=True)
class RecognitionScore:
    """Of the frames in which the object's box is in the image.

    ``box_error_pixels`` is the mean distance between the boxes' centres; a frame without a box
    keeps the last one, and those before the first take that one. ``known_share`` is the share of
    frames with a known action, ``precision`` that of these with the right one (None: never known),
    ``vertex_error_m`` the mean over frames in which the right object is known (None: there are
    none). ``known_share`` is None for what knows no actions.
    """

    frames: int
    box_error_pixels: float
    known_share: float | None = None
    precision: float | None = None
    vertex_error_m: float | None = None


def score_answers(
    answers: Answers, action: int, frames: Sequence[RecordedFrame], truth: Array, gauge: ErrorGauge
) -> RecognitionScore:
    """The score of answers about an action, against the true boxes (T, 4) and the labels."""
    counted = np.isfinite(truth).all(axis=1)
    known = answers.known[counted]
    right = known == action
    errors = gauge.compare(answers.track, true_track(frames)).vertex_m[counted][right]
    errors = errors[np.isfinite(errors)]
    return RecognitionScore(
        len(known),
        box_error(answers.boxes, truth),
        float((known != UNKNOWN).mean()),
        float(right.sum() / (known != UNKNOWN).sum()) if (known != UNKNOWN).any() else None,
        float(errors.mean()) if len(errors) else None,
    )


def score_boxes(boxes: Array, truth: Array) -> RecognitionScore:
    """The score of boxes (T, 4) alone."""
    return RecognitionScore(int(np.isfinite(truth).all(axis=1).sum()), box_error(boxes, truth))


def box_error(boxes: Array, truth: Array) -> float:
    """The mean distance in pixels of the centres of boxes (T, 4) from the true ones."""
    given = np.flatnonzero(np.isfinite(boxes).all(axis=1))
    counted = np.isfinite(truth).all(axis=1)
    if not len(given) or not counted.any():
        return float("nan")
    last = np.searchsorted(given, np.arange(len(boxes)), side="right") - 1
    held = boxes[given[np.maximum(last, 0)]]
    apart = centres(held[counted]) - centres(truth[counted])
    return float(np.linalg.norm(apart, axis=1).mean())
