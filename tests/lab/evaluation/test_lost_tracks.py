"""When a track or a body is lost, and how long until it is found."""

import numpy as np
import pytest
from inhand_lab.evaluation.lost_tracks import lost_bodies, lost_frames, recoveries, recoveries_after
from waving import HAND, STANDING

SECOND = 10**9


def flags(text: str) -> np.ndarray:
    return np.array([letter == "x" for letter in text])


def times(frames: int) -> np.ndarray:
    return np.arange(frames) * SECOND


def test_a_track_is_lost_above_20_cm_and_found_below_10() -> None:
    errors = np.array([0.15, 0.21, 0.15, 0.11, 0.09, 0.15, 0.19])
    assert lost_frames(errors, np.ones(7, bool)).tolist() == flags(".xxx...").tolist()


def test_a_frame_without_a_pose_is_lost_until_the_error_is_small() -> None:
    errors = np.array([np.nan, 0.05, 0.05, 0.15, 0.05])
    given = np.array([False, True, False, True, True])
    assert lost_frames(errors, given).tolist() == flags("x.xx.").tolist()


def test_recovery_takes_until_the_first_frame_found() -> None:
    told = recoveries(flags("..xxx..x..."), times(11))
    assert (told.losses, told.seconds) == (2, pytest.approx(4.0))


def test_what_is_never_found_counts_until_the_end() -> None:
    told = recoveries(flags("...xx"), times(5))
    assert (told.losses, told.seconds) == (1, pytest.approx(2.0))


def test_nothing_lost_is_no_recovery() -> None:
    assert recoveries(flags("...."), times(4)).losses == 0


def test_recovery_after_the_body_counts_from_its_return() -> None:
    body = flags(".xx....xx...")
    track = flags("..xxx....x..")
    told = recoveries_after(body, track, times(12))
    assert (told.losses, told.seconds) == (2, pytest.approx(2.0 + 1.0))


def test_a_track_that_outlives_the_body_recovers_at_once() -> None:
    told = recoveries_after(flags(".xx.."), flags("....."), times(5))
    assert (told.losses, told.seconds) == (1, 0.0)


def test_a_body_that_does_not_return_is_no_recovery() -> None:
    assert recoveries_after(flags("..xxx"), flags("..xxx"), times(5)).losses == 0


def test_a_body_is_lost_without_pelvis_or_with_a_joint_far_off_above_the_legs() -> None:
    true = np.repeat(STANDING[None], 4, axis=0)
    seen = true.copy()
    seen[1, 0] = np.nan
    seen[2, HAND, 0] += 0.3
    seen[3, 15, 0] += 0.3
    assert lost_bodies(seen, true).tolist() == [False, True, True, False]


def test_without_true_joints_only_a_missing_pelvis_tells() -> None:
    seen = np.repeat(STANDING[None], 2, axis=0)
    seen[1] = np.nan
    assert lost_bodies(seen, np.full((2, 20, 3), np.nan)).tolist() == [False, True]
