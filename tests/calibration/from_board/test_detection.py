"""Boards are found in pictures as far as they can be, in either pattern, and not two as one."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_calibration.from_board.board import CharucoBoard, printed_board, written_board
from inhand_calibration.from_board.detection import BoardFinder
from inhand_calibration.from_board.lens import Lens
from inhand_calibration.rigid import moved, rigid, turned_by
from inhand_lab.sensing.board_view import BoardPrint, view_of_boards
from numpy.typing import NDArray

LENS = Lens(525.0, 525.0, 319.5, 239.5, 640, 480, (0.05, -0.1, 0.001, 0.0005, 0.0))
EVEN = written_board("8x6:42:30:4x4_50")


def placed(
    board: CharucoBoard, x: float, y: float, z: float, *turn_deg: float
) -> NDArray[np.float64]:
    """A board's pose (4, 4) with its middle at a place."""
    turn = turned_by(np.radians(turn_deg))
    return rigid(turn, np.array([x, y, z]) - turn @ board.outline.mean(axis=0))


def picture(*boards: tuple[CharucoBoard, NDArray[np.float64]]) -> NDArray[np.uint8]:
    prints = [(BoardPrint(board), pose[None]) for board, pose in boards]
    return view_of_boards(prints, LENS, np.random.default_rng(5))


def test_corners_are_found_within_a_fifth_of_a_pixel() -> None:
    board = printed_board("a3")
    pose = placed(board, 0.05, -0.03, 0.9, 20.0, -35.0, 100.0)
    corners = BoardFinder([board]).find(picture((board, pose)))
    assert corners is not None
    assert len(corners.numbers) == len(board.corners)
    true = LENS.project(moved(pose, board.corners[corners.numbers]))
    assert np.abs(corners.pixels - true).max() < 0.2


@pytest.mark.parametrize("legacy", [False, True])
def test_the_pattern_of_an_even_board_is_told_apart(legacy: bool) -> None:
    shown = replace(EVEN, legacy=legacy)
    view = picture((shown, placed(shown, 0.0, 0.0, 0.8, 10.0, 20.0, 5.0)))
    finder = BoardFinder([EVEN])
    for _ in range(finder.DECIDED + 1):
        corners = finder.find(view)
        assert corners is not None
        assert corners.board == shown
    assert list(finder.seen) == [shown]


def test_two_boards_of_one_kind_are_not_taken_for_one() -> None:
    board = printed_board("a4")
    view = picture(
        (board, placed(board, -0.14, 0.0, 0.6, 5.0, 5.0, 0.0)),
        (board, placed(board, 0.14, 0.0, 0.65, -5.0, 10.0, 20.0)),
    )
    corners = BoardFinder([board]).find(view)
    assert corners is not None
    assert corners.twice
    assert len(corners.numbers) == 0


def test_nothing_is_found_where_no_board_is() -> None:
    assert BoardFinder([printed_board("a4")]).find(picture()) is None
