"""A board as a PDF to print: in true size, with its name and a line by which to see that it is."""

from pathlib import Path

import numpy as np
from inhand_runtime.errors import InhandError
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline

from inhand_calibration.arrays import Array
from inhand_calibration.from_board.board import MM, CharucoBoard

PAPERS_MM = {"a4": (210.0, 297.0), "letter": (215.9, 279.4), "a3": (297.0, 420.0)}
INCH_MM = 25.4
LINE_MM = 150.0
"""Length of the line that is measured on the print."""
TEXT_BAND_MM = 24.0
"""Height below the board that the text and the line take."""
LINE_UP_MM, NAME_UP_MM, HINT_UP_MM = 13.0, 17.5, 6.5
TICK_MM = 2.0
HINT = (
    "Print at 100 % (actual size), and measure this line: it is "
    f"{LINE_MM:.0f} mm long. Glue the sheet flat on a stiff board."
)


def write_sheet(path: Path, board: CharucoBoard, paper: str) -> None:
    """Write a vector PDF of a board on a paper of ``PAPERS_MM``; raises InhandError."""
    try:
        sheet_figure(board, paper).savefig(
            path, format="pdf", metadata={"Title": board.name, "CreationDate": None}
        )
    except OSError as error:
        raise InhandError(f"cannot write {path}: {error.strerror}") from None


def sheet_figure(board: CharucoBoard, paper: str) -> Figure:
    """Draw the sheet: its axes are the paper in millimetres, y downwards."""
    width, height = PAPERS_MM[paper]
    figure = Figure(figsize=(width / INCH_MM, height / INCH_MM))
    FigureCanvasPdf(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0), xlim=(0.0, width), ylim=(height, 0.0))
    axes.axis("off")
    black = board.black_rectangles() / MM + [*board_corner_mm(board, paper), 0.0, 0.0]
    # One path, so that no viewer's smoothing shows seams between neighbours.
    axes.add_patch(PathPatch(_outline(black), facecolor="black", linewidth=0.0, antialiased=True))
    left, right = (width - LINE_MM) / 2.0, (width + LINE_MM) / 2.0
    line = height - LINE_UP_MM
    axes.plot([left, right], [line, line], color="black", linewidth=0.5, solid_capstyle="butt")
    for end in (left, right):
        ends = [line - TICK_MM, line + TICK_MM]
        axes.plot([end, end], ends, color="black", linewidth=0.3)
    size = f"{board.columns} × {board.rows} squares of {board.square_m / MM:g} mm"
    markers = f"markers of {board.marker_m / MM:g} mm, {board.dictionary}"
    title = f"{board.name}: {size}, {markers}"
    for text, up in ((title, NAME_UP_MM), (HINT, HINT_UP_MM)):
        axes.text(width / 2.0, height - up, text, ha="center", va="center", fontsize=8)
    return figure


def board_corner_mm(board: CharucoBoard, paper: str) -> tuple[float, float]:
    """Return where the upper left corner of a board is on its paper, x and y."""
    width, height = PAPERS_MM[paper]
    board_width, board_height = (side / MM for side in board.size_m)
    return (width - board_width) / 2.0, (height - TEXT_BAND_MM - board_height) / 2.0


def _outline(rectangles: Array) -> Outline:
    """Join rectangles (N, 4) of x, y, width, height into one outline."""
    x, y, width, height = rectangles.T
    corners = np.stack(
        [(x, y), (x + width, y), (x + width, y + height), (x, y + height), (x, y)], axis=0
    )
    codes = [Outline.MOVETO, *[Outline.LINETO] * 3, Outline.CLOSEPOLY] * len(rectangles)
    return Outline(np.moveaxis(corners, 2, 0).reshape(-1, 2), codes)
