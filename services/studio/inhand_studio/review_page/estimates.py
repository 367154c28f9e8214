"""What is known of a recording's objects: their true tracks, and those that are compared."""

import threading
from collections.abc import Callable

import numpy as np
from inhand_lab.datasets.tracks import Track
from inhand_runtime.errors import InhandError
from inhand_tracker.model.model_file import load_model
from inhand_tracker.shape.shape import ObjectShape

from inhand_studio.review_page.errors import Estimate, errors_of
from inhand_studio.review_page.parameters import ReviewParameters
from inhand_studio.review_page.recording import OnProgress, ReviewedRecording, empty_poses
from inhand_studio.review_page.tracking_job import TrackedPoses, TrackingTask
from inhand_studio.scene_parts import TRACKED, Colour
from inhand_studio.shapes import Shapes

RECORDED = "as it was recorded"
OTHERS: tuple[Colour, ...] = ((80, 160, 255), (255, 170, 40), (200, 110, 250), (60, 210, 210))
"""Colours of what is tracked anew, in turn."""


class Estimates:
    """The estimates of a recording's objects; thread-safe."""

    def __init__(
        self, recording: ReviewedRecording, shapes: Shapes, parameters: ReviewParameters
    ) -> None:
        self._recording, self._shapes, self._parameters = recording, shapes, parameters
        self._lock = threading.Lock()
        self._of_models: dict[str, ObjectShape] = {}
        self._truth: dict[str, Track] = {}
        self._estimates: list[Estimate] = []
        self._made = 0

    def of(self, name: str) -> list[Estimate]:
        """The estimates of one object."""
        with self._lock:
            return [one for one in self._estimates if one.object == name]

    def made_anew(self) -> list[Estimate]:
        """The estimates of all objects that trackers made here."""
        with self._lock:
            return [one for one in self._estimates if one.name != RECORDED]

    def shape(self, name: str) -> tuple[ObjectShape | None, str | None]:
        """Return an object's shape, or None and a sentence on why there is none."""
        shape, why = self._shapes.find(name)
        with self._lock:
            return (shape, why) if shape is not None else (self._of_models.get(name), why)

    def read(self, on_progress: OnProgress) -> None:
        """Read the labels, and the poses that were recorded, of all objects, until it is stopped.

        Raises RecordingError.
        """
        recording = self._recording
        parts = [
            *((poses, False) for poses in recording.labels.items()),
            *((poses, True) for poses in recording.poses.items()),
        ]
        users: dict[str, dict[int, int]] = {}
        for number, ((name, poses), recorded) in enumerate(parts):
            on_part = _part_of(on_progress, number, len(parts))
            read = poses.track(recording.times_ns, users.get(name, {}), on_part)
            if read is None:
                return
            if recorded:
                self._add(Estimate(RECORDED, name, TRACKED, read[0], None))
                continue
            users[name] = read[1]
            with self._lock:
                self._truth[name] = read[0]
        on_progress(1.0)

    def add_tracked(self, task: TrackingTask, tracked: TrackedPoses) -> None:
        """Add what a tracker made of the recording; raises InhandError where it is of another."""
        times_ns = self._recording.times_ns
        places = np.searchsorted(times_ns, tracked.times_ns)
        frames = np.minimum(places, len(times_ns) - 1)
        known = times_ns[frames] == tracked.times_ns
        if not known.any():
            raise InhandError("the poses are of no frame that is shown: choose the same camera")
        track = empty_poses(len(times_ns))
        track.translations[frames[known]] = tracked.track.translations[known]
        track.rotations[frames[known]] = tracked.track.rotations[known]
        shape = load_model(task.model).shape
        with self._lock:
            self._of_models[tracked.object] = shape
            colour = OTHERS[self._made % len(OTHERS)]
            self._made += 1
        name = f"{self._made}: {task.method} with {task.model.name}"
        self._add(Estimate(name, tracked.object, colour, track, None))

    def _add(self, estimate: Estimate) -> None:
        """Keep an estimate with its errors, as far as they can be known."""
        shape, _ = self.shape(estimate.object)
        truth = self._truth.get(estimate.object)
        errors = None
        if shape is not None and truth is not None:
            errors = errors_of(estimate.track, truth, shape, self._parameters)
        whole = Estimate(estimate.name, estimate.object, estimate.colour, estimate.track, errors)
        with self._lock:
            self._estimates.append(whole)


def _part_of(on_progress: OnProgress, number: int, parts: int) -> Callable[[float], bool]:
    return lambda share: on_progress((number + share) / parts)
