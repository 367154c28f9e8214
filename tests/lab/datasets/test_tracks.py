"""Tracks of poses with gaps."""

import numpy as np
from inhand_lab.datasets.tracks import empty_track
from inhand_tracker.geometry.estimate import LOST, Estimate

IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])


def at(x: float) -> Estimate:
    return Estimate("tracked", 1.0, np.array([x, 0.0, 1.0]), IDENTITY, np.eye(6))


def test_a_gap_holds_the_last_pose_and_what_comes_before_the_first_holds_none() -> None:
    track = empty_track(5)
    for frame, estimate in enumerate((LOST, at(0.1), LOST, LOST, at(0.2))):
        track.put(frame, estimate)
    assert track.given.tolist() == [False, True, False, False, True]
    np.testing.assert_array_equal(track.held().translations[:, 0], [np.nan, 0.1, 0.1, 0.1, 0.2])
    assert np.isnan(track.covariances[[0, 2, 3]]).all()
    np.testing.assert_array_equal(track.covariances[4], np.eye(6))


def test_the_chosen_frames_are_a_track_of_their_own() -> None:
    track = empty_track(3)
    track.put(2, at(0.3))
    chosen = track.of(np.array([False, True, True]))
    assert chosen.given.tolist() == [False, True]
    np.testing.assert_array_equal(chosen.translations[1], [0.3, 0.0, 1.0])
