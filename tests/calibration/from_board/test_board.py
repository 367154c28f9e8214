"""Boards as OpenCV knows them, and as they are written and printed."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from inhand_calibration.from_board.board import (
    SQUARES_MM,
    CharucoBoard,
    printed_board,
    written_board,
)
from inhand_runtime.errors import SettingsError
from numpy.typing import NDArray

EVEN = written_board("8x6:42:30:4x4_50")


def drawn(board: CharucoBoard, pixels_in_cell: int = 4) -> NDArray[np.uint8]:
    """A board's black rectangles as a picture without margin."""
    scale = pixels_in_cell * 6 / board.marker_m
    width, height = (round(side * scale) for side in board.size_m)
    picture = np.full((height, width), 255, np.uint8)
    for x, y, across, down in board.black_rectangles() * scale:
        picture[round(y) : round(y + down), round(x) : round(x + across)] = 0
    return picture


@pytest.mark.parametrize("board", [printed_board("a4"), printed_board("a3")])
def test_what_is_black_is_what_opencv_draws(board: CharucoBoard) -> None:
    picture = drawn(board)
    theirs = board.drawn.generateImage(picture.shape[::-1])
    assert np.array_equal(picture, theirs)


@pytest.mark.parametrize("legacy", [False, True])
def test_either_pattern_of_an_even_board_is_what_opencv_draws(legacy: bool) -> None:
    board = replace(EVEN, legacy=legacy)
    picture = drawn(board, 5)
    theirs = board.drawn.generateImage(picture.shape[::-1])
    assert float(np.mean(picture != theirs)) < 0.01
    other = replace(board, legacy=not legacy).drawn.generateImage(picture.shape[::-1])
    assert float(np.mean(picture != other)) > 0.3


def test_boards_for_different_papers_share_no_marker() -> None:
    numbers = [set(np.ravel(printed_board(paper).drawn.getIds()).tolist()) for paper in SQUARES_MM]
    assert sum(map(len, numbers)) == len(set.union(*numbers))


def test_a_board_that_was_printed_smaller_has_smaller_squares() -> None:
    board = printed_board("a4").scaled(0.97)
    assert board.square_m == pytest.approx(0.97 * 0.036)
    assert board.corners[0] == pytest.approx([0.97 * 0.036, 0.97 * 0.036, 0.0])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("8x6", "is no board"),
        ("8x6:40:30:5x5_10O", "no family of markers is named 5x5_10o"),
        ("8x6:30:40:5x5_100", "markers smaller than its squares"),
        ("2x6:40:30:5x5_100", "3 × 3 squares at least"),
        ("20x20:40:30:5x5_100", "which is too few"),
        ("8x6:4.0.0:30:5x5_100", "in millimetres"),
    ],
)
def test_a_board_that_cannot_be_is_refused(text: str, said: str) -> None:
    with pytest.raises(SettingsError) as error:
        written_board(text)
    assert said in str(error.value)


def test_opencv_is_told_of_the_legacy_pattern() -> None:
    assert isinstance(EVEN.drawn, cv2.aruco.CharucoBoard)
    assert replace(EVEN, legacy=True).drawn.getLegacyPattern()
