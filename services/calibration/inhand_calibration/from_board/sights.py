"""What one camera saw of the board, picture by picture, and where a corner was in between."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from inhand_calibration.arrays import Array
from inhand_calibration.from_board.board import CharucoBoard
from inhand_calibration.from_board.detection import LEAST_CORNERS
from inhand_calibration.from_board.lens import Lens
from inhand_calibration.rigid import moved, rigid, turned_by

NS = 1e-9
LONGEST_GAP_S = 0.25
"""Time between two sights, at most, between which a board that stands still is taken to do so."""
STRAIGHT_S = 0.08
"""Time between two sights, at most, between which corners are taken to go straight on: hands turn
back within a tenth of a second."""
FALSE_CORNER_PX = 4.0
"""Error of a corner from which on it is a false one, beside four times the sight's own error."""
AMBIGUOUS = 1.6
"""Ratio of the errors of the two poses that a flat board may have below which either may be it."""


@dataclass(frozen=True)
class Sight:
    """Corners of the board in one picture of a camera, in pixels of its lens.

    ``numbers`` (N,) of the corners, ``pixels`` (N, 2), and the picture's time by the camera's clock
    with its uncertainty.
    """

    time_ns: int
    numbers: NDArray[np.int64]
    pixels: Array
    uncertainty_ns: int = 0


@dataclass(frozen=True)
class BoardPose:
    """A board's pose in a camera (4, 4), its error in pixels, and another that fits as well."""

    camera_from_board: Array
    error_px: float
    other: Array | None = None

    @property
    def ambiguous(self) -> bool:
        """Whether another pose fits as well: small boards may lean to either side."""
        return self.other is not None


@dataclass(frozen=True)
class Between:
    """Corners at one instant: numbers (N,), pixels (N, 2) and their velocities (N, 2), pixels a
    second; or, of a board that stood still, the mean of so many instants. ``bend_px`` is how far
    from a straight way they may have gone between two pictures."""

    numbers: NDArray[np.int64]
    pixels: Array
    velocities: Array
    instants: int = 1
    bend_px: float = 0.0

    def with_another(self, other: "Between") -> "Between":
        """Return the mean with another instant, of the corners that both have."""
        numbers, first, second = np.intersect1d(
            self.numbers, other.numbers, assume_unique=True, return_indices=True
        )
        total = self.instants + other.instants
        share = other.instants / total
        return Between(
            numbers,
            (1.0 - share) * self.pixels[first] + share * other.pixels[second],
            (1.0 - share) * self.velocities[first] + share * other.velocities[second],
            total,
            max(self.bend_px, other.bend_px),
        )


@dataclass(frozen=True)
class CameraSights:
    """All sights of one camera, in the order of their times."""

    camera: str
    lens: Lens
    board: CharucoBoard
    sights: tuple[Sight, ...]

    @cached_property
    def times_s(self) -> Array:
        """Times (S,) of the sights by the camera's clock, seconds since ``start_ns``."""
        return np.array([(one.time_ns - self.start_ns) * NS for one in self.sights])

    @property
    def start_ns(self) -> int:
        """Time of the first sight."""
        return self.sights[0].time_ns if self.sights else 0

    @cached_property
    def speeds(self) -> Array:
        """Speed (S,) of the board in each sight, pixels a second; NaN where it is not known."""
        speeds = np.full(len(self.sights), np.nan)
        for index in range(len(self.sights)):
            steps = [
                _velocities(self.sights[one], self.sights[one + 1])
                for one in (index - 1, index)
                if 0 <= one < len(self.sights) - 1
            ]
            known = [float(np.median(np.linalg.norm(one, axis=1))) for one in steps if len(one)]
            if known:
                speeds[index] = max(known)
        return speeds

    def at(self, time_ns: int, still_px_s: float) -> Between | None:
        """Find where corners were at a time of the camera's clock, between two sights.

        Beside a gap, the nearest sight stands for it where the board was slower than
        ``still_px_s``. None where it was not seen.
        """
        times = self.times_s
        seconds = (time_ns - self.start_ns) * NS
        after = int(np.searchsorted(times, seconds))
        if after < len(times) and times[after] == seconds:
            return self._held(after, still_px_s, moving=True)
        gap = times[after] - times[after - 1] if 0 < after < len(times) else np.inf
        if gap <= (STRAIGHT_S if self._moves(after, still_px_s) else LONGEST_GAP_S):
            between = self._joined(after - 1, seconds)
            if len(between.numbers) >= LEAST_CORNERS:
                return between
        beside = [one for one in (after - 1, after) if 0 <= one < len(times)]
        nearest = min(beside, key=lambda one: abs(times[one] - seconds), default=None)
        if nearest is None or abs(times[nearest] - seconds) > LONGEST_GAP_S / 2.0:
            return None
        return self._held(nearest, still_px_s, moving=False)

    def _moves(self, after: int, still_px_s: float) -> bool:
        """Whether the board moves between a sight and the one before."""
        speeds = self.speeds[after - 1 : after + 1]
        return not bool((speeds <= still_px_s).all())

    def _joined(self, index: int, seconds: float) -> Between:
        before, after = self.sights[index], self.sights[index + 1]
        share = (seconds - self.times_s[index]) / (self.times_s[index + 1] - self.times_s[index])
        numbers, first, second = np.intersect1d(
            before.numbers, after.numbers, assume_unique=True, return_indices=True
        )
        start, end = before.pixels[first], after.pixels[second]
        span = float(self.times_s[index + 1] - self.times_s[index])
        velocities, bend = (end - start) / span, self._bend(index, span)
        return Between(numbers, (1.0 - share) * start + share * end, velocities, bend_px=bend)

    def _bend(self, index: int, span: float) -> float:
        """How far from a straight way corners may go between a sight and the next, pixels: by how
        their velocity differs before and after; or, where that is not seen, as if they stopped."""
        around = [
            _velocities(self.sights[one], self.sights[one + 1])
            for one in (index - 1, index + 1)
            if 0 <= one < len(self.sights) - 1
        ]
        if len(around) == 2 and all(len(one) for one in around):
            before, after = (np.median(one, axis=0) for one in around)
            return float(np.linalg.norm(after - before)) * span / 16.0
        here = np.median(_velocities(self.sights[index], self.sights[index + 1]), axis=0)
        return float(np.linalg.norm(here)) * span / 4.0

    def _held(self, index: int, still_px_s: float, *, moving: bool) -> Between | None:
        """Take a sight as it is; one that moves at its own time alone."""
        sight, speed = self.sights[index], self.speeds[index]
        slow = np.isfinite(speed) and speed <= still_px_s
        if not slow and not moving:
            return None
        velocities = np.zeros_like(sight.pixels)
        for one in (index - 1, index):
            if 0 <= one < len(self.sights) - 1:
                before, after = self.sights[one], self.sights[one + 1]
                step = _velocities(before, after)
                if len(step):
                    velocities[:] = np.median(step, axis=0)
        return Between(sight.numbers, sight.pixels, velocities)


def board_pose(lens: Lens, board: CharucoBoard, sight: Sight) -> BoardPose | None:
    """Find how the board lies by one sight; None where its corners fit no pose."""
    places = board.corners[sight.numbers]
    rays = lens.undistorted(sight.pixels)
    count, turns, shifts, _ = cv2.solvePnPGeneric(
        places, rays, np.eye(3), None, flags=cv2.SOLVEPNP_IPPE
    )
    candidates = []
    for index in range(count):
        pose = _pose(turns[index], shifts[index])
        points = moved(pose, places)
        if np.isfinite(pose).all() and (points[:, 2] > 0.0).all():
            turn, shift = cv2.solvePnPRefineLM(
                places, rays, np.eye(3), None, turns[index].copy(), shifts[index].copy()
            )
            refined = _pose(turn, shift)
            errors = sight.pixels - lens.project(moved(refined, places))
            candidates.append((float(np.sqrt(np.mean(errors**2))), index, refined))
    if not candidates:
        return None
    candidates.sort(key=lambda one: one[:2])
    error, _, best = candidates[0]
    other = candidates[1][2] if len(candidates) > 1 else best
    fits = len(candidates) > 1 and candidates[1][0] < AMBIGUOUS * error
    differs = not np.allclose(other, best, atol=1e-3)
    return BoardPose(best, error, other if fits and differs else None)


def _pose(turn: Any, shift: Any) -> Array:
    """Return what OpenCV says of a pose, a rotation vector and a translation, as a matrix."""
    return rigid(turned_by(np.ravel(turn).astype(float)), np.ravel(shift).astype(float))


def without_false_corners(lens: Lens, board: CharucoBoard, sight: Sight) -> Sight | None:
    """Leave out corners that no flat board can have there; None where too few remain."""
    rays = lens.undistorted(sight.pixels)
    flat = board.corners[sight.numbers][:, :2]
    onto, _ = cv2.findHomography(flat, rays, cv2.RANSAC, FALSE_CORNER_PX / lens.fx)
    if onto is None:
        return None
    mapped = np.column_stack([flat, np.ones(len(flat))]) @ onto.T
    errors = np.linalg.norm(mapped[:, :2] / mapped[:, 2:] - rays, axis=1) * lens.fx
    good = errors < max(FALSE_CORNER_PX, 4.0 * float(np.median(errors)))
    if good.sum() < LEAST_CORNERS:
        return None
    return Sight(sight.time_ns, sight.numbers[good], sight.pixels[good], sight.uncertainty_ns)


def _velocities(before: Sight, after: Sight) -> Array:
    """Velocities (N, 2) of the corners that both have, pixels a second; none beside a gap."""
    span = (after.time_ns - before.time_ns) * NS
    if not 0.0 < span <= LONGEST_GAP_S:
        return np.empty((0, 2))
    _, first, second = np.intersect1d(
        before.numbers, after.numbers, assume_unique=True, return_indices=True
    )
    return (after.pixels[second] - before.pixels[first]) / span
