"""A tracker that makes its poses without pictures says so."""

import pytest
from inhand_runtime.health import HealthBoard
from inhand_tracker.live.pictures import POSES, PictureWatch


def running() -> tuple[HealthBoard, PictureWatch]:
    board = HealthBoard("tracker", "mug")
    board.state = "running"
    return board, PictureWatch(board)


def test_poses_with_their_pictures_are_no_trouble() -> None:
    board, watch = running()
    for number in range(2 * POSES):
        watch.note(number % 10 != 0)
    assert board.report().troubles == ()


def test_poses_without_pictures_degrade_until_they_come_again() -> None:
    board, watch = running()
    for number in range(2 * POSES):
        watch.note(number % 2 == 0)
    report = board.report()
    assert report.state == "degraded"
    assert f"{POSES // 2} of {POSES} poses are without picture" in report.troubles[0]
    for _ in range(POSES):
        watch.note(True)
    assert board.report().state == "running"


def test_what_changes_with_every_pose_is_not_logged_with_every_pose(
    caplog: pytest.LogCaptureFixture,
) -> None:
    _, watch = running()
    for number in range(2 * POSES):
        watch.note(number < POSES)
    assert len(caplog.records) <= 3


def test_a_camera_without_pictures_is_no_trouble() -> None:
    board, watch = running()
    for _ in range(2 * POSES):
        watch.note(False)
    assert board.report().troubles == ()
