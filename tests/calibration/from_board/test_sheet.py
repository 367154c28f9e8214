"""The sheet to print: true to size, and what is drawn is what is detected."""

import re
import zlib
from pathlib import Path

import numpy as np
import pytest
from inhand_calibration.from_board.board import MM, SQUARES_MM, printed_board
from inhand_calibration.from_board.detection import BoardFinder
from inhand_calibration.from_board.sheet import (
    PAPERS_MM,
    board_corner_mm,
    sheet_figure,
    write_sheet,
)
from inhand_runtime.errors import InhandError
from matplotlib.backends.backend_agg import FigureCanvasAgg

POINT_MM = 25.4 / 72.0
DOTS_IN_MM = 4.0


@pytest.mark.parametrize("paper", PAPERS_MM)
def test_what_is_drawn_is_detected_where_it_is_drawn(paper: str) -> None:
    board = printed_board(paper)
    figure = sheet_figure(board, paper)
    figure.set_dpi(DOTS_IN_MM * 25.4)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()  # type: ignore[no-untyped-call]
    pixels = canvas.buffer_rgba()  # type: ignore[no-untyped-call]
    grey = np.asarray(pixels)[..., 0].copy()
    corners = BoardFinder([printed_board(one) for one in SQUARES_MM]).find(grey)
    assert corners is not None
    assert corners.board == board
    assert len(corners.numbers) == len(board.corners)
    places_mm = board.corners[:, :2] / MM + board_corner_mm(board, paper)
    seen_mm = (corners.pixels + 0.5) / DOTS_IN_MM
    errors_mm = seen_mm - places_mm
    assert np.abs(errors_mm).max() < 1.0 / DOTS_IN_MM  # the whole drawing is moved onto dots
    assert np.ptp(errors_mm, axis=0).max() < 0.1


@pytest.mark.parametrize("paper", PAPERS_MM)
def test_the_pdf_has_the_size_of_its_paper_and_squares_of_theirs(
    paper: str, tmp_path: Path
) -> None:
    path = tmp_path / "board.pdf"
    write_sheet(path, printed_board(paper), paper)
    data = path.read_bytes()
    box = re.search(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", data)
    assert box is not None
    size_mm = [float(one) * POINT_MM for one in box.groups()]
    assert size_mm == pytest.approx(PAPERS_MM[paper], abs=0.01)
    assert _first_square_mm(data) == pytest.approx(SQUARES_MM[paper], abs=0.01)


def _first_square_mm(data: bytes) -> float:
    """Width of what is filled first in a PDF's page, millimetres."""
    for stream in re.findall(rb"stream\r?\n(.*?)\r?\nendstream", data, re.DOTALL):
        try:
            text = zlib.decompress(stream)
        except zlib.error:
            continue
        way = re.search(rb"([\d.]+) [\d.]+ m\n([\d.]+) [\d.]+ l\n[\d. ]+ l\n[\d. ]+ l\nh", text)
        if way is not None and b"f" in text:
            widths = [
                abs(float(end) - float(start))
                for start, end in re.findall(
                    rb"([\d.]+) [\d.]+ m\n([\d.]+) [\d.]+ l\n[\d. ]+ l\n[\d. ]+ l\nh", text
                )
            ]
            return widths[1] * POINT_MM if widths[0] > 500.0 else widths[0] * POINT_MM
    raise AssertionError("nothing is filled")


def test_a_sheet_that_cannot_be_written_is_said(tmp_path: Path) -> None:
    with pytest.raises(InhandError, match="cannot write"):
        write_sheet(tmp_path / "nowhere" / "board.pdf", printed_board("a4"), "a4")
