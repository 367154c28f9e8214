"""Tracks: an object's poses frame by frame, as a tracker estimates them or as they truly are."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.geometry.estimate import Estimate

from inhand_lab.datasets.recorded_frames import RecordedFrame


@dataclass(frozen=True)
class Track:
    """Poses camera_from_object of T frames: (T, 3) and (T, 4), NaN where there is none.

    ``covariances`` (T, 6, 6) are those of a tracker's estimates, NaN where it gives none; None
    where the poses are no tracker's.
    """

    translations: Array
    rotations: Array
    covariances: Array | None = None

    def put(self, frame: int, estimate: Estimate) -> None:
        """Write a tracker's estimate into one frame."""
        if estimate.translation is not None and estimate.rotation is not None:
            self.translations[frame] = estimate.translation
            self.rotations[frame] = estimate.rotation
        if self.covariances is not None and estimate.covariance is not None:
            self.covariances[frame] = estimate.covariance

    @property
    def given(self) -> Flags:
        """Flags (T,) of the frames in which there is a pose."""
        return np.isfinite(self.translations[:, 0])

    def held(self) -> "Track":
        """Return the track with each gap filled by the last pose before it."""
        last = np.maximum.accumulate(np.where(self.given, np.arange(len(self.given)), 0))
        return Track(self.translations[last], self.rotations[last])

    def of(self, chosen: Flags) -> "Track":
        """Return the track of the chosen frames (T,) alone."""
        covariances = None if self.covariances is None else self.covariances[chosen]
        return Track(self.translations[chosen], self.rotations[chosen], covariances)


def empty_track(frames: int) -> Track:
    """Return a track without any pose yet."""
    return Track(
        np.full((frames, 3), np.nan),
        np.full((frames, 4), np.nan),
        np.full((frames, 6, 6), np.nan),
    )


def true_track(frames: Sequence[RecordedFrame]) -> Track:
    """Return the labels of a recording as a track."""
    track = empty_track(len(frames))
    for index, frame in enumerate(frames):
        if frame.label is not None and frame.label.camera_from_object is not None:
            track.translations[index] = frame.label.camera_from_object.translation
            track.rotations[index] = frame.label.camera_from_object.rotation
    return track


def true_joints(frames: Sequence[RecordedFrame]) -> Array:
    """Return the true joints (T, 20, 3) that a simulated world's labels hold; NaN elsewhere."""
    joints = np.full((len(frames), 20, 3), np.nan)
    for index, frame in enumerate(frames):
        if frame.label is not None and frame.label.person_joints is not None:
            joints[index] = frame.label.person_joints
    return joints
