"""ChArUco boards: which there are, and where what is black on them stands.

A board's frame is OpenCV's: its origin is the upper left corner, x goes right, y down, and z into
the paper, away from who looks at it. Its corners are those inside, where four squares meet.
"""

import re
from dataclasses import dataclass, replace
from functools import cached_property

import cv2
import numpy as np
from inhand_runtime.errors import SettingsError
from inhand_runtime.settings_errors import suggestion

from inhand_calibration.arrays import Array

DICTIONARIES = {
    name.removeprefix("DICT_").lower(): value
    for name, value in vars(cv2.aruco).items()
    if re.fullmatch(r"DICT_\dX\d_\d+", name)
}
"""OpenCV's families of markers by name, such as ``4x4_100``."""
PRINTED_DICTIONARY = "4x4_100"
PRINTED_COLUMNS, PRINTED_ROWS = 5, 7
"""An odd number of rows: there OpenCV's two patterns are the same."""
MARKER_SHARE = 0.75
"""Side of a marker as a share of its square's, on boards that we print."""
MARKERS_OF_PRINTED = PRINTED_COLUMNS * PRINTED_ROWS // 2
MM = 0.001
SQUARES_MM = {"a4": 36.0, "letter": 34.0, "a3": 52.0}
"""Side of a square, millimetres, on each paper. Each board has markers of its own, so that a board
in view says by itself which one it is."""


@dataclass(frozen=True)
class CharucoBoard:
    """A ChArUco board: squares, their and the markers' sides in metres, and which markers it has.

    ``legacy`` is the pattern of OpenCV before 4.6, where the upper left square of a board with an
    even number of rows is white.
    """

    name: str
    columns: int
    rows: int
    square_m: float
    marker_m: float
    dictionary: str = PRINTED_DICTIONARY
    first_marker: int = 0
    legacy: bool = False

    @property
    def size_m(self) -> tuple[float, float]:
        """Width and height of its squares together, metres."""
        return self.columns * self.square_m, self.rows * self.square_m

    @property
    def markers(self) -> int:
        """How many markers it has."""
        return len(self.drawn.getIds())

    @property
    def has_two_patterns(self) -> bool:
        """Whether the legacy pattern differs."""
        return self.rows % 2 == 0

    @cached_property
    def drawn(self) -> cv2.aruco.CharucoBoard:
        """The board as OpenCV knows it."""
        whites = self.columns * self.rows // 2
        board = cv2.aruco.CharucoBoard(
            (self.columns, self.rows),
            self.square_m,
            self.marker_m,
            cv2.aruco.getPredefinedDictionary(DICTIONARIES[self.dictionary]),
            np.arange(self.first_marker, self.first_marker + whites),
        )
        board.setLegacyPattern(self.legacy)
        return board

    @cached_property
    def corners(self) -> Array:
        """Places (N, 3) of its corners in its frame, by their numbers, metres."""
        return np.asarray(self.drawn.getChessboardCorners(), float)

    @cached_property
    def outline(self) -> Array:
        """Its four outer corners (4, 3), metres, clockwise from the upper left."""
        width, height = self.size_m
        return np.array([(0, 0, 0), (width, 0, 0), (width, height, 0), (0, height, 0)], float)

    def scaled(self, share: float) -> "CharucoBoard":
        """Return the board as a printer made it that prints at another scale."""
        return replace(self, square_m=self.square_m * share, marker_m=self.marker_m * share)

    def black_rectangles(self) -> Array:
        """Return what is black: rectangles (N, 4) of x, y, width, height, metres.

        None overlap: chessboard squares, and in markers runs of black cells.
        """
        side = self.square_m
        white_first = self.has_two_patterns and self.legacy
        squares = [
            (column * side, row * side, side, side)
            for row in range(self.rows)
            for column in range(self.columns)
            if (row + column) % 2 == (1 if white_first else 0)
        ]
        cells = [
            rectangle
            for identifier, places in zip(
                np.ravel(self.drawn.getIds()), self.drawn.getObjPoints(), strict=True
            )
            for rectangle in self._cells(int(identifier), np.asarray(places, float)[0, :2])
        ]
        return np.array(squares + cells)

    def _cells(self, identifier: int, corner: Array) -> list[tuple[float, float, float, float]]:
        """Runs of black cells, row by row, of the marker whose upper left corner (2,) that is."""
        dictionary = cv2.aruco.getPredefinedDictionary(DICTIONARIES[self.dictionary])
        side = dictionary.markerSize + 2
        black = cv2.aruco.generateImageMarker(dictionary, identifier, side) == 0
        cell = self.marker_m / side
        runs = []
        for row, line in enumerate(black):
            edges = np.flatnonzero(np.diff(np.concatenate([[0], line.astype(int), [0]])))
            for start, end in edges.reshape(-1, 2):
                x, y = corner + cell * np.array([start, row])
                runs.append((float(x), float(y), float(end - start) * cell, cell))
        return runs


def printed_board(paper: str) -> CharucoBoard:
    """Return the board that ``inhand calibrate --board`` prints on a paper of ``SQUARES_MM``."""
    number = list(SQUARES_MM).index(paper)
    square = SQUARES_MM[paper] * MM
    return CharucoBoard(
        f"inhand-{paper}",
        PRINTED_COLUMNS,
        PRINTED_ROWS,
        square,
        MARKER_SHARE * square,
        first_marker=number * MARKERS_OF_PRINTED,
    )


_WRITTEN = re.compile(
    r"(?P<columns>\d+)x(?P<rows>\d+):(?P<square>[\d.]+):(?P<marker>[\d.]+):(?P<dictionary>\w+)"
)


def written_board(text: str) -> CharucoBoard:
    """Read ``COLUMNSxROWS:SQUARE_MM:MARKER_MM:DICTIONARY``; raises SettingsError."""
    match = _WRITTEN.fullmatch(text.lower())
    if match is None:
        raise SettingsError(
            f"{text!r} is no board: write COLUMNSxROWS:SQUARE_MM:MARKER_MM:DICTIONARY, "
            "such as 8x6:40:30:5x5_100"
        )
    if match["dictionary"] not in DICTIONARIES:
        raise SettingsError(
            f"{text!r}: no family of markers is named {match['dictionary']}"
            + suggestion(match["dictionary"], DICTIONARIES)
        )
    try:
        square, marker = float(match["square"]) * MM, float(match["marker"]) * MM
    except ValueError:
        raise SettingsError(f"{text!r}: write sides in millimetres, such as 40 or 37.5") from None
    columns, rows = int(match["columns"]), int(match["rows"])
    if min(columns, rows) < 3 or not 0.0 < marker < square:
        raise SettingsError(
            f"{text!r}: a board has 3 × 3 squares at least, and markers smaller than its squares"
        )
    most = int(match["dictionary"].rpartition("_")[2])
    if columns * rows // 2 > most:
        raise SettingsError(f"{text!r}: {match['dictionary']} has {most} markers, which is too few")
    return CharucoBoard(text.lower(), columns, rows, square, marker, match["dictionary"])
