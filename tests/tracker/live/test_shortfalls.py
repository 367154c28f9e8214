"""A tracker that makes its poses without pictures, or skips skeletons, says so."""

import pytest
from inhand_runtime.health import HealthBoard
from inhand_tracker.live.shortfalls import JUDGED, Shortfall


def running() -> tuple[HealthBoard, Shortfall]:
    board = HealthBoard("tracker", "mug")
    board.state = "running"
    return board, Shortfall(board, "pictures", "poses are without picture")


def test_a_few_that_go_short_are_no_trouble() -> None:
    board, pictures = running()
    for number in range(2 * JUDGED):
        pictures.note(number % 10 == 0)
    assert board.report().troubles == ()


def test_many_that_go_short_degrade_until_all_is_whole_again() -> None:
    board, pictures = running()
    for number in range(2 * JUDGED):
        pictures.note(number % 2 == 1)
    report = board.report()
    assert report.state == "degraded"
    assert f"{JUDGED // 2} of {JUDGED} poses are without picture" in report.troubles[0]
    for _ in range(JUDGED):
        pictures.note(False)
    assert board.report().state == "running"


def test_what_changes_with_every_pose_is_not_logged_with_every_pose(
    caplog: pytest.LogCaptureFixture,
) -> None:
    _, pictures = running()
    for number in range(2 * JUDGED):
        pictures.note(number >= JUDGED)
    assert len(caplog.records) <= 3


def test_what_never_came_is_not_expected() -> None:
    board, pictures = running()
    for _ in range(2 * JUDGED):
        pictures.note(True)
    assert board.report().troubles == ()
