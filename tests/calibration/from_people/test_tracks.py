"""Movements of people: without a delay, whatever frames are lost."""

import numpy as np
import pytest
from inhand_calibration.arrays import Array
from inhand_calibration.from_people.parameters import MovementParameters
from inhand_calibration.from_people.skeletons import CameraSkeletons
from inhand_calibration.from_people.tracks import find_tracks, observe
from inhand_schemas.joints import Joint

PARAMETERS = MovementParameters()


def _skeletons(seconds: Array, places: Array, people: Array | None = None) -> CameraSkeletons:
    """A body that is a point, at places (N, 3)."""
    joints = np.repeat(places[:, None], 20, axis=1)
    numbers = np.zeros(len(seconds), int) if people is None else people
    times = np.rint(1e9 * seconds).astype(np.int64)
    return CameraSkeletons("c", times, numbers, joints, np.ones((len(seconds), 20)))


def _going(seconds: Array) -> Array:
    return np.stack([1.5 * seconds, 0.0 * seconds, 3.0 - 0.5 * seconds], axis=1)


def test_an_even_walk_is_followed_without_a_delay() -> None:
    random = np.random.default_rng(1)
    seconds = np.arange(300) / 30.0
    seconds = seconds[random.random(300) > 0.3]
    seconds -= seconds[0]
    (track,) = find_tracks(_skeletons(seconds, _going(seconds)), PARAMETERS)
    times = np.arange(0.0, seconds[-1], 0.037)
    seen = observe([track], times)
    known = seen.support[0, :, Joint.HEAD] > 0.0
    assert known.mean() > 0.9
    np.testing.assert_allclose(seen.positions[0, known, 0], _going(times[known]), atol=1e-9)
    np.testing.assert_allclose(
        seen.velocities[0, known, 0], np.tile([1.5, 0, -0.5], (known.sum(), 1)), atol=1e-6
    )


def test_nothing_is_said_of_a_gap_or_of_a_missing_joint() -> None:
    seconds = np.arange(300) / 30.0
    seconds = seconds[(seconds < 4.0) | (seconds > 4.4)]
    seen = _skeletons(seconds, _going(seconds))
    seen.joints[:, Joint.ANKLE_LEFT] = np.nan
    seen.confidences[:, Joint.WRIST_LEFT] = 0.05
    (track,) = find_tracks(seen, PARAMETERS)
    at = observe([track], np.array([2.0, 4.2, 6.0])).support[0]
    assert (at[:, Joint.HEAD] > 0.0).tolist() == [True, False, True]
    assert not at[:, [Joint.ANKLE_LEFT, Joint.WRIST_LEFT]].any()


def test_a_jump_of_a_number_to_somebody_else_begins_another_movement() -> None:
    seconds = np.arange(300) / 30.0
    places = _going(seconds)
    places[150:] += [0.0, 0.0, 2.0]
    tracks = find_tracks(_skeletons(seconds, places), PARAMETERS)
    assert sorted(round(track.start) for track in tracks) == [0, 5]


def test_people_of_one_frame_are_movements_of_their_own() -> None:
    seconds = np.repeat(np.arange(150) / 30.0, 2)
    people = np.tile([3, 8], 150)
    places = _going(seconds) + np.where(people[:, None] == 3, 0.0, 1.0)
    tracks = find_tracks(_skeletons(seconds, places, people), PARAMETERS)
    assert sorted(track.person for track in tracks) == [3, 8]
    assert all(track.spread == pytest.approx(tracks[0].spread) for track in tracks)


def test_rows_that_do_not_fit_are_refused() -> None:
    seconds = np.arange(3.0)
    with pytest.raises(ValueError, match="shapes"):
        CameraSkeletons(
            "c", seconds.astype(int), np.zeros(2, int), np.zeros((3, 20, 3)), np.zeros((3, 20))
        )
    with pytest.raises(ValueError, match="times fall"):
        _skeletons(-seconds, _going(seconds))
