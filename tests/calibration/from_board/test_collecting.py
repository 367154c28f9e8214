"""What cameras see of a board is gathered, and what cannot be one board is refused."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_calibration.errors import CalibrationError
from inhand_calibration.from_board.board import CharucoBoard, printed_board
from inhand_calibration.from_board.collecting import BoardSights
from inhand_calibration.from_board.lens import Lens
from inhand_calibration.rigid import moved, rigid, turned_by
from inhand_lab.benchmarks.board_calibration import frame_of, info_of
from inhand_lab.sensing.board_view import BoardPrint, view_of_boards
from inhand_schemas.messages import ColourImage, RgbdFrame
from msgspec import structs
from numpy.typing import NDArray

LENS = Lens(260.0, 260.0, 159.5, 119.5, 320, 240)
BOARD, SMALL = printed_board("a3"), printed_board("a4")


def placed(board: CharucoBoard, x: float, z: float) -> NDArray[np.float64]:
    turn = turned_by(np.radians([10.0, 15.0, 5.0]))
    return rigid(turn, np.array([x, 0.0, z]) - turn @ board.outline.mean(axis=0))


def shown(*boards: tuple[CharucoBoard, float, float], lens: Lens = LENS) -> RgbdFrame:
    """A picture of boards, each at x and z."""
    prints = [(BoardPrint(board), placed(board, x, z)[None]) for board, x, z in boards]
    return frame_of(view_of_boards(prints, lens, np.random.default_rng(3)), 1_000)


def test_a_picture_of_another_size_than_the_info_is_in_its_pixels() -> None:
    sights = BoardSights([BOARD, SMALL])
    large = replace(LENS, fx=520.0, fy=520.0, cx=319.5, cy=239.5, width=640, height=480)
    sights.introduce("front", info_of(LENS))
    assert sights.add("front", shown((BOARD, 0.0, 0.6), lens=large)) is not None
    (camera,) = sights.sights()
    (sight,) = camera.sights
    points = moved(placed(BOARD, 0.0, 0.6), BOARD.corners[sight.numbers])
    assert np.abs(sight.pixels - LENS.project(points)).max() < 0.2


def test_two_boards_are_refused_whether_alike_or_not() -> None:
    alike, unlike = BoardSights([BOARD, SMALL]), BoardSights([BOARD, SMALL])
    for sights in (alike, unlike):
        sights.introduce("front", info_of(LENS))
    assert alike.add("front", shown((SMALL, -0.13, 0.4), (SMALL, 0.13, 0.42))) is None
    with pytest.raises(CalibrationError, match="two boards of one kind"):
        alike.sights()
    unlike.add("front", shown((BOARD, 0.0, 0.6)))
    unlike.add("front", shown((SMALL, 0.0, 0.4)))
    with pytest.raises(CalibrationError, match="two boards are in view, inhand-a"):
        unlike.sights()


def test_damaged_pictures_are_counted_and_said() -> None:
    sights = BoardSights([BOARD])
    sights.introduce("front", info_of(LENS))
    broken = structs.replace(shown(), colour=ColourImage("jpeg", 320, 240, b"no picture"))
    assert sights.add("front", broken) is None
    assert "front: left out as damaged: 1 picture" in sights.notes()


def test_a_camera_that_changes_its_lens_is_refused() -> None:
    sights = BoardSights([BOARD])
    sights.introduce("front", info_of(LENS))
    with pytest.raises(CalibrationError, match="front has other intrinsics than before"):
        sights.introduce("front", info_of(replace(LENS, fx=270.0)))
