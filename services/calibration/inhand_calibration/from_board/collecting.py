"""Gathers what cameras see of a board, picture by picture."""

import threading
from collections import Counter, defaultdict
from collections.abc import Sequence

import numpy as np
from inhand_runtime.pixels import decode_depth, decode_grey
from inhand_runtime.wording import counted
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, ColourImage, RgbdFrame

from inhand_calibration.arrays import Array
from inhand_calibration.errors import CalibrationError
from inhand_calibration.from_board.board import CharucoBoard
from inhand_calibration.from_board.depth_floor import depth_points
from inhand_calibration.from_board.detection import BoardFinder, Corners
from inhand_calibration.from_board.lens import Lens
from inhand_calibration.from_board.sights import CameraSights, Sight, without_false_corners

DEPTH_EVERY_S = 3.0
"""Seconds between two depth images of a camera in which the floor is looked for."""
MOST_DEPTHS = 8
"""Depth images of a camera that are kept."""
TWO_BOARDS = 0.2
"""Share of the sights with markers at two places from which on there are two boards."""
MIXED = 0.1
"""Share of the sights that another board than the usual one may have, at most."""


class BoardSights:
    """Gathers the sights of all cameras; ``add`` may be called from several threads."""

    def __init__(self, boards: Sequence[CharucoBoard]) -> None:
        self._boards = boards
        self._finders = threading.local()
        self._lock = threading.Lock()
        self._infos: dict[str, CameraInfo] = {}
        self._sights: dict[str, list[tuple[CharucoBoard, Sight]]] = defaultdict(list)
        self._twice: Counter[str] = Counter()
        self._frames: Counter[str] = Counter()
        self._damaged: Counter[str] = Counter()
        self._points: dict[str, list[tuple[int, Array]]] = defaultdict(list)

    def introduce(self, camera: str, info: CameraInfo) -> None:
        """Take note of how a camera sees; raises CalibrationError where that changes meanwhile."""
        with self._lock:
            known = self._infos.setdefault(camera, info)
            if Lens.of_info(known) != Lens.of_info(info):
                raise CalibrationError(
                    f"{camera} has other intrinsics than before: calibrate with one kind of "
                    "picture, and with recordings of that kind alone"
                )

    @property
    def cameras(self) -> tuple[str, ...]:
        """Names of the cameras that said how they see, in the order of the alphabet."""
        return tuple(sorted(self._infos))

    def frames(self, camera: str) -> int:
        """How many pictures of a camera were looked at."""
        return self._frames[camera]

    def add(self, camera: str, frame: RgbdFrame) -> Array | None:
        """Look for the board in a picture: its middle (2,), pixels, None where it is not seen.

        Pictures before the camera's info, without colour or with damage are left out.
        """
        info = self._infos.get(camera)
        if info is None or frame.colour is None:
            return None
        try:
            grey = decode_grey(frame.colour)
            self._keep_depth(camera, info, frame)
        except MessageError:
            with self._lock:
                self._damaged[camera] += 1
            return None
        if not hasattr(self._finders, "own"):
            self._finders.own = BoardFinder(self._boards)
        corners = self._finders.own.find(grey)
        with self._lock:
            self._frames[camera] += 1
            if corners is not None and corners.twice:
                self._twice[camera] += 1
                return None
        if corners is None:
            return None
        return self._keep(camera, info, frame, frame.colour, corners)

    def _keep(
        self,
        camera: str,
        info: CameraInfo,
        frame: RgbdFrame,
        colour: ColourImage,
        corners: Corners,
    ) -> Array | None:
        scale = np.array([info.width / colour.width, info.height / colour.height])
        pixels = (corners.pixels + 0.5) * scale - 0.5
        sight = without_false_corners(
            Lens.of_info(info),
            corners.board,
            Sight(frame.time_ns, corners.numbers, pixels, frame.time_uncertainty_ns),
        )
        if sight is None:
            return None
        with self._lock:
            self._sights[camera].append((corners.board, sight))
        middle: Array = sight.pixels.mean(axis=0)
        return middle

    def _keep_depth(self, camera: str, info: CameraInfo, frame: RgbdFrame) -> None:
        """Keep points of a depth image now and then; raises MessageError."""
        if frame.depth is None:
            return
        with self._lock:
            kept = self._points[camera]
            due = not kept or frame.time_ns - kept[-1][0] > DEPTH_EVERY_S * 1e9
            if len(kept) >= MOST_DEPTHS or not due:
                return
            kept.append((frame.time_ns, np.empty((0, 3))))
            place = len(kept) - 1
        points = depth_points(decode_depth(frame.depth), info)
        with self._lock:
            kept[place] = (frame.time_ns, points)

    def points(self) -> dict[str, Array]:
        """Return points (N, 3) of the depth of each camera that has any, in its frame, metres."""
        return {
            camera: np.concatenate([points for _, points in kept])
            for camera, kept in self._points.items()
            if kept
        }

    def sights(self) -> list[CameraSights]:
        """Return the sights of each camera; raises CalibrationError for two boards at once."""
        seen = Counter(board for own in self._sights.values() for board, _ in own)
        board = seen.most_common(1)[0][0] if seen else self._boards[0]
        self._require_one_board(seen, board)
        cameras = []
        for camera in self.cameras:
            own = [sight for kind, sight in self._sights[camera] if kind == board]
            own.sort(key=lambda sight: sight.time_ns)
            times = np.array([sight.time_ns for sight in own], np.int64)
            first = np.unique(times, return_index=True)[1]
            sights = tuple(own[index] for index in first)
            lens = Lens.of_info(self._infos[camera])
            cameras.append(CameraSights(camera, lens, board, sights))
        return cameras

    def _require_one_board(self, seen: Counter[CharucoBoard], board: CharucoBoard) -> None:
        for camera, count in self._twice.items():
            if count > TWO_BOARDS * (count + len(self._sights[camera])):
                raise CalibrationError(
                    f"{camera} sees the same markers at two places in "
                    f"{counted(count, 'picture')}: there are two boards of one kind in view; put "
                    "one away"
                )
        for other, count in seen.items():
            if other != board and count > MIXED * seen.total():
                raise CalibrationError(
                    f"two boards are in view, {board.name} and {other.name}: put one away, or say "
                    "by --pattern which one is meant"
                )

    def notes(self) -> list[str]:
        """Return sentences on what was seen, and left out."""
        seen = Counter(board for own in self._sights.values() for board, _ in own)
        notes = []
        for board, count in seen.most_common(1):
            pattern = ""
            if board.has_two_patterns:
                kind = (
                    "legacy (before OpenCV 4.6)" if board.legacy else "new (OpenCV 4.6 and later)"
                )
                pattern = f", of the {kind} pattern"
            notes.append(f"the board {board.name}{pattern} is seen in {counted(count, 'picture')}")
        notes += [
            f"{camera}: left out as they show two boards: {counted(count, 'picture')}"
            for camera, count in sorted(self._twice.items())
        ]
        notes += [
            f"{camera}: left out as damaged: {counted(count, 'picture')}"
            for camera, count in sorted(self._damaged.items())
        ]
        return notes
