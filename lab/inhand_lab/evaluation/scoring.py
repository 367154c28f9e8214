"""Scores a tracker on a recording: its poses against the labels."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.datasets.recorded_frames import RecordedFrame
from inhand_lab.datasets.tracks import Track, true_joints, true_track
from inhand_lab.datasets.wild_labels import wild_labels
from inhand_lab.evaluation.lost_tracks import (
    Recoveries,
    lost_bodies,
    lost_frames,
    recoveries,
    recoveries_after,
)
from inhand_lab.evaluation.pose_errors import ErrorGauge, region_share


@dataclass(frozen=True)
class Score:
    """The score of a tracker in the labelled frames of one recording.

    The errors are means over the frames in which a pose was given, or had been given before: it
    counts until the next. Shares are of all labelled frames; a frame before the first pose is
    neither within 5 cm and 5° nor under the curve, and lost. ``region_share`` is the share of
    poses whose own 90 % region, by their covariance, holds the true one; None where none has one.
    ``stated`` are, of each pose with a covariance, the deviation of its vertices that this states
    and their error, in metres.
    """

    frames: int
    vertex_error_m: float
    translation_m: float
    rotation_rad: float
    close_share: float
    area_under_curve: float
    lost_share: float
    recoveries: Recoveries
    body_recoveries: Recoveries
    region_share: float | None = None
    stated: tuple[tuple[float, float], ...] = ()


class Judge:
    """Scores tracks by the truth of one recording.

    ``joints`` (T, 20, 3) is the body that the trackers saw, NaN where missing. Wild labels are no
    truth.
    """

    def __init__(self, frames: Sequence[RecordedFrame], joints: Array, gauge: ErrorGauge) -> None:
        times = np.array([frame.time_ns for frame in frames], np.int64)
        true = true_track(frames)
        self._labelled = true.given & ~wild_labels(true, times)
        self._true = true.of(self._labelled)
        self._times = times[self._labelled]
        bodies = lost_bodies(joints, true_joints(frames))
        self._body_lost = bodies[self._labelled]
        self._gauge = gauge

    def score(self, track: Track) -> Score | None:
        """Score a track; None where no labelled frame has a pose, its own or an earlier one."""
        errors = self._gauge.compare(track.held().of(self._labelled), self._true)
        if not np.isfinite(errors.vertex_m).any():
            return None
        own = track.of(self._labelled)
        stated = np.stack((self._gauge.stated_m(own), errors.vertex_m), axis=1)
        lost = lost_frames(errors.vertex_m, track.given[self._labelled])
        return Score(
            len(lost),
            float(np.nanmean(errors.vertex_m)),
            float(np.nanmean(errors.translation_m)),
            float(np.nanmean(errors.rotation_rad)),
            float(errors.close().mean()),
            errors.area_under_curve(),
            float(lost.mean()),
            recoveries(lost, self._times),
            recoveries_after(self._body_lost, lost, self._times),
            region_share(own, self._true, own.covariances),
            tuple((float(one), float(error)) for one, error in stated[np.isfinite(stated).all(1)]),
        )
