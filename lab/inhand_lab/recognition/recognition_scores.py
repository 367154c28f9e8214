"""Scores how well an object that was not given was recognised and found, on one recording."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.recognition.object_recogniser import ObjectRecogniser
from inhand_tracker.recognition.recognition import Recognition

from inhand_lab.datasets.observations import Observation
from inhand_lab.datasets.recorded_frames import RecordedFrame
from inhand_lab.datasets.tracks import Track, empty_track, true_track
from inhand_lab.evaluation.pose_errors import ErrorGauge
from inhand_lab.recognition.true_boxes import box_centres

UNKNOWN = -1
"""The number that stands for no action."""


@dataclass(frozen=True)
class Answers:
    """What a method answered to T frames: the recognised ``actions`` (T,), ``boxes`` (T, 4), and a
    pose of the recognised action's object."""

    actions: Indices
    boxes: Array
    track: Track

    @classmethod
    def empty(cls, frames: int) -> Answers:
        """Make answers in which nothing is recognised in any frame yet."""
        boxes = np.full((frames, 4), np.nan)
        return cls(np.full(frames, UNKNOWN, np.int64), boxes, empty_track(frames))

    def put(self, frame: int, recognition: Recognition) -> None:
        """Write the answer to one frame."""
        if recognition.known is not None:
            self.actions[frame] = recognition.known
            self.track.put(frame, recognition.estimate)
        if recognition.box is not None:
            self.boxes[frame] = recognition.box


@dataclass(frozen=True)
class RecognitionScore:
    """A score on the ``frames`` in which the object's box is in the image.

    ``box_error_pixels`` is the mean distance between the boxes' centres; a frame without a box
    keeps the last one, and those before the first take that one. ``recognised_share`` is the share
    of frames with a recognised action (None: the method recognises none), ``precision`` that of
    these with the right one (None: there are none), ``vertex_error_m`` the mean over frames in
    which the right object is recognised (None: there are none).
    """

    frames: int
    box_error_pixels: float
    recognised_share: float | None = None
    precision: float | None = None
    vertex_error_m: float | None = None

    @property
    def right_share(self) -> float | None:
        """Share of frames in which the right action is recognised (None: none ever is)."""
        if self.recognised_share is None:
            return None
        return self.recognised_share * (self.precision or 0.0)


def answer_together(
    recognisers: Sequence[ObjectRecogniser],
    observations: Iterable[Observation],
    frames: int,
    camera: Intrinsics | None = None,
) -> list[Answers]:
    """Let several methods answer to the same frames; ``camera`` is for boxes without an image."""
    answers = [Answers.empty(frames) for _ in recognisers]
    for index, seen in enumerate(observations):
        for recogniser, answer in zip(recognisers, answers, strict=True):
            if seen.somebody_else:
                recogniser.restart()
            recogniser.convention = seen.convention
            answer.put(index, recogniser.step(seen.joints, seen.time_ns, seen.image, camera))
    return answers


def score_answers(
    answers: Answers, action: int, frames: Sequence[RecordedFrame], truth: Array, gauge: ErrorGauge
) -> RecognitionScore:
    """Score answers about an action, against the true boxes (T, 4) and the labels."""
    counted = np.isfinite(truth).all(axis=1)
    actions = answers.actions[counted]
    recognised, right = actions != UNKNOWN, actions == action
    errors = gauge.compare(answers.track, true_track(frames)).vertex_m[counted][right]
    errors = errors[np.isfinite(errors)]
    return RecognitionScore(
        frames=len(actions),
        box_error_pixels=box_error(answers.boxes, truth),
        recognised_share=float(recognised.mean()),
        precision=float(right.sum() / recognised.sum()) if recognised.any() else None,
        vertex_error_m=float(errors.mean()) if len(errors) else None,
    )


def score_boxes(boxes: Array, truth: Array) -> RecognitionScore:
    """Score boxes (T, 4) alone."""
    return RecognitionScore(int(np.isfinite(truth).all(axis=1).sum()), box_error(boxes, truth))


def box_error(boxes: Array, truth: Array) -> float:
    """Mean distance in pixels of the centres of boxes (T, 4) from the true ones."""
    given = np.flatnonzero(np.isfinite(boxes).all(axis=1))
    counted = np.isfinite(truth).all(axis=1)
    if not len(given) or not counted.any():
        return float("nan")
    last = np.searchsorted(given, np.arange(len(boxes)), side="right") - 1
    held = boxes[given[np.maximum(last, 0)]]
    offsets = box_centres(held[counted]) - box_centres(truth[counted])
    return float(np.linalg.norm(offsets, axis=1).mean())
