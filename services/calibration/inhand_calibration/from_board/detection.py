"""A board in a picture: which of its corners are where, and what is wrong with the sight."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from inhand_calibration.arrays import Array, Indices
from inhand_calibration.from_board.board import DICTIONARIES, CharucoBoard

LEAST_CORNERS = 6
"""Corners of a sight, at least: fewer hardly say how the board lies."""
ENLARGED = 2
"""Factor by which pictures are enlarged: OpenCV's windows around corners are of a fixed number of
pixels, and take in less of the neighbouring squares then. Corners of rendered boards err half as
much, and boards are found a third farther away."""
WIDE_ENOUGH = 1600
"""Width of pictures, pixels, from which on they are not enlarged."""
LEAST_SPREAD = 0.02
"""Spread of a sight's corners across, at least, as a share of that along: those on one line do not
say how the board lies."""


@dataclass(frozen=True)
class Corners:
    """Corners of a board in one picture: numbers (N,) and pixels (N, 2), centres of pixels whole.

    ``twice`` says that markers were seen at two places: there are two boards in view, and no corner
    is given.
    """

    board: CharucoBoard
    numbers: Indices
    pixels: Array
    twice: bool = False


class BoardFinder:
    """Finds one of several boards in pictures; those of two patterns are tried in both.

    Once a pattern was seen often enough the other is not looked for.
    """

    DECIDED = 5
    """Pictures in which one pattern was seen, and the other never, until that is the board's."""

    def __init__(self, boards: Sequence[CharucoBoard]) -> None:
        both = [
            replace(board, legacy=legacy)
            for board in boards
            for legacy in ((False, True) if board.has_two_patterns else (board.legacy,))
        ]
        self._detectors = [(board, _detector(board)) for board in both]
        self._markers = {
            dictionary: cv2.aruco.ArucoDetector(
                cv2.aruco.getPredefinedDictionary(DICTIONARIES[dictionary]), _parameters()
            )
            for dictionary in dict.fromkeys(board.dictionary for board in both)
        }
        self.seen: Counter[CharucoBoard] = Counter()
        """In how many pictures each board was seen."""

    def find(self, grey: NDArray[np.uint8]) -> Corners | None:
        """Find the board of which most is seen in a picture (H, W); None where there is none."""
        enlarged = ENLARGED if grey.shape[1] < WIDE_ENOUGH else 1
        if enlarged > 1:
            size = (grey.shape[1] * enlarged, grey.shape[0] * enlarged)
            grey = np.asarray(cv2.resize(grey, size, interpolation=cv2.INTER_CUBIC), np.uint8)
        best: Corners | None = None
        for dictionary, detector in self._markers.items():
            places, numbers, _ = detector.detectMarkers(grey)
            if not places:
                continue
            for board, charuco in self._candidates(dictionary):
                corners = _corners(grey, board, charuco, places, np.ravel(numbers).astype(np.int64))
                if corners is not None and (best is None or _rank(corners) > _rank(best)):
                    best = corners
        if best is not None and not best.twice:
            self.seen[best.board] += 1
        if best is None:
            return None
        return replace(best, pixels=(best.pixels + 0.5) / enlarged - 0.5)

    def _candidates(self, dictionary: str) -> list[tuple[CharucoBoard, cv2.aruco.CharucoDetector]]:
        decided = {
            replace(board, legacy=not board.legacy)
            for board, count in self.seen.items()
            if board.has_two_patterns
            and count >= self.DECIDED
            and not self.seen[replace(board, legacy=not board.legacy)]
        }
        return [
            (board, detector)
            for board, detector in self._detectors
            if board.dictionary == dictionary and board not in decided
        ]


def _rank(corners: Corners) -> tuple[bool, int]:
    return corners.twice, len(corners.numbers)


def _corners(
    grey: NDArray[np.uint8],
    board: CharucoBoard,
    charuco: cv2.aruco.CharucoDetector,
    places: Sequence[Any],
    numbers: Indices,
) -> Corners | None:
    """Find a board's corners between its markers, which were seen at places (4, 2) each."""
    own = (numbers >= board.first_marker) & (numbers < board.first_marker + board.markers)
    if not own.any():
        return None
    chosen = numbers[own]
    if _seen_twice(chosen):
        return Corners(board, np.empty(0, np.int64), np.empty((0, 2)), twice=True)
    seen: Any = charuco.detectBoard(
        grey,
        markerCorners=[places[int(one)] for one in np.flatnonzero(own)],
        markerIds=chosen[:, None].astype(np.int32),
    )
    corners, found = seen[0], np.ravel([] if seen[1] is None else seen[1])
    if len(found) < LEAST_CORNERS:
        return None
    order = np.argsort(found)
    sight = Corners(
        board, found[order].astype(np.int64), np.reshape(corners, (-1, 2))[order].astype(float)
    )
    return sight if _spreads(board.corners[sight.numbers]) else None


def _seen_twice(numbers: Indices) -> bool:
    """Whether there are two boards: a single marker seen twice is a false one, not a board."""
    return int((np.unique(numbers, return_counts=True)[1] > 1).sum()) > 1


def _spreads(places: Array) -> bool:
    """Whether places (N, 3) on a board are on more than one line."""
    along, across = np.linalg.svd(places[:, :2] - places[:, :2].mean(axis=0), compute_uv=False)
    return bool(across > LEAST_SPREAD * along)


def _detector(board: CharucoBoard) -> cv2.aruco.CharucoDetector:
    return cv2.aruco.CharucoDetector(
        board.drawn, cv2.aruco.CharucoParameters(), _parameters(), cv2.aruco.RefineParameters()
    )


def _parameters() -> cv2.aruco.DetectorParameters:
    """How markers are read: finer than by default, for boards that are small in the picture."""
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    parameters.minMarkerPerimeterRate = 0.015
    parameters.perspectiveRemovePixelPerCell = 8
    parameters.perspectiveRemoveIgnoredMarginPerCell = 0.25
    return parameters
