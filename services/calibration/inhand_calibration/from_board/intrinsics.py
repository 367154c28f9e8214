"""Whether a camera's intrinsics are right: what it sees of the board under those that it publishes,
and under those that fit best."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import cv2
import numpy as np

from inhand_calibration.arrays import Array, Indices
from inhand_calibration.from_board.board import CharucoBoard
from inhand_calibration.from_board.lens import Lens
from inhand_calibration.from_board.sights import CameraSights, Sight, board_pose
from inhand_calibration.rigid import moved

Verdict = Literal["right", "wrong", "unsure"]


@dataclass(frozen=True)
class IntrinsicsParameters:
    """When intrinsics are called wrong."""

    sights: int = 30
    """Sights that are looked at, at most."""
    least_sights: int = 8
    """Sights that are needed for a verdict."""
    apart: float = 0.03
    """Movement between two of them, at least, as a share of the picture's width."""
    still_px_s: float = 25.0
    """Speed of the board, at most, in a sight that is looked at."""
    evidence: float = 12.0
    """Ratio of what the best intrinsics mend, per number, to what is left (an F statistic) from
    which on they are better by more than chance."""
    matters_px: float = 0.4
    """How far the best ones, in the root mean square, must move corners to matter, pixels."""
    sure: float = 0.01
    """Deviation of the focal length, as a share of it, beyond which nothing can be said."""


DEFAULT_INTRINSICS = IntrinsicsParameters()


@dataclass(frozen=True)
class IntrinsicsCheck:
    """What the board says of a camera's intrinsics.

    ``published_px`` and ``best_px`` are root mean square errors of corners under the published and
    the ``best`` intrinsics, None where too few sights fit them. ``focal_deviation`` is that of the
    best focal length, a share of it.
    """

    verdict: Verdict
    sights: int
    published_px: float
    best_px: float = float("nan")
    best: Lens | None = None
    focal_deviation: float = float("inf")


def check_intrinsics(
    camera: CameraSights, parameters: IntrinsicsParameters = DEFAULT_INTRINSICS
) -> IntrinsicsCheck:
    """Compare a camera's lens with the one that explains its sights best."""
    chosen = _chosen(camera, parameters)
    errors = [_errors(camera.lens, camera.board, sight) for sight in chosen]
    published = _root_mean_square(errors)
    if len(chosen) < parameters.least_sights:
        return IntrinsicsCheck("unsure", len(chosen), published)
    best, deviation = _best_lens(camera, chosen)
    best_errors = [_errors(best, camera.board, sight) for sight in chosen]
    best_px = _root_mean_square(best_errors)
    evidence = _evidence(errors, best_errors, len(best.coefficients) + 4)
    matters = np.sqrt(max(published**2 - best_px**2, 0.0)) > parameters.matters_px
    verdict: Verdict = "right"
    if evidence > parameters.evidence and matters:
        verdict = "wrong"
    elif deviation > parameters.sure:
        verdict = "unsure"
    return IntrinsicsCheck(verdict, len(chosen), published, best_px, best, deviation)


def _chosen(camera: CameraSights, parameters: IntrinsicsParameters) -> list[Sight]:
    """Sights of the board standing still, each elsewhere than those before."""
    apart = parameters.apart * camera.lens.width
    chosen: list[Sight] = []
    middles: list[Array] = []
    for sight, speed in zip(camera.sights, camera.speeds, strict=True):
        if not speed <= parameters.still_px_s:
            continue
        middle = _outline_in_picture(camera.board, sight)
        if all(np.abs(middle - other).max() > apart for other in middles):
            chosen.append(sight)
            middles.append(middle)
    picked = np.linspace(0, len(chosen) - 1, min(len(chosen), parameters.sights)).astype(int)
    return [chosen[index] for index in np.unique(picked)]


def _outline_in_picture(board: CharucoBoard, sight: Sight) -> Array:
    """About where a board's outline (4, 2) is in the picture, by an affine fit."""
    flat = np.column_stack([board.corners[sight.numbers][:, :2], np.ones(len(sight.numbers))])
    affine, *_ = np.linalg.lstsq(flat, sight.pixels, rcond=None)
    outline: Array = np.column_stack([board.outline[:, :2], np.ones(4)]) @ affine
    return outline


def _errors(lens: Lens, board: CharucoBoard, sight: Sight) -> Array:
    """Errors (N, 2) of a sight's corners in pixels, the board standing where they are least."""
    pose = board_pose(lens, board, sight)
    if pose is None:
        return np.full((len(sight.numbers), 2), np.nan)
    points = moved(pose.camera_from_board, board.corners[sight.numbers])
    return sight.pixels - lens.project(points)


def _root_mean_square(errors: Sequence[Array]) -> float:
    joined = np.concatenate([*errors, np.empty((0, 2))])
    kept = joined[_kept(joined)]
    return float(np.sqrt(np.mean(kept**2))) if len(kept) else float("nan")


def _kept(errors: Array) -> Indices:
    """Which errors (N, 2) are not far beyond the others."""
    sizes = np.linalg.norm(errors, axis=1)
    limit = 5.0 * np.nanmedian(sizes) if len(sizes) else 0.0
    return np.flatnonzero(sizes <= limit)


def _evidence(published: Sequence[Array], best: Sequence[Array], numbers: int) -> float:
    """How much better the best intrinsics are than by chance; those of a sight err together."""
    before, after = np.concatenate(published), np.concatenate(best)
    kept = np.intersect1d(_kept(before), _kept(after))
    if len(kept) == 0:
        return 0.0
    left, mended = np.sum(after[kept] ** 2), np.sum(before[kept] ** 2) - np.sum(after[kept] ** 2)
    freedom = max(2 * len(kept) - 6 * len(published) - numbers, 1)
    return float(mended / numbers / max(left / freedom, 1e-9))


def _best_lens(camera: CameraSights, sights: Sequence[Sight]) -> tuple[Lens, float]:
    """Fit a lens to sights, from the published one on, and the deviation of its focal length as a
    share of it."""
    lens, board = camera.lens, camera.board
    coefficients = lens.coefficients
    flags = cv2.CALIB_USE_INTRINSIC_GUESS
    if len(coefficients) >= 8:
        flags |= cv2.CALIB_RATIONAL_MODEL
    if len(coefficients) <= 4:
        flags |= cv2.CALIB_FIX_K3
    _, matrix, fitted, _, _, deviations, _, _ = cv2.calibrateCameraExtended(
        [board.corners[sight.numbers].astype(np.float32) for sight in sights],
        [sight.pixels.astype(np.float32) for sight in sights],
        (lens.width, lens.height),
        lens.matrix,
        coefficients.copy(),
        flags=flags,
    )
    distortion = tuple(float(one) for one in np.ravel(fitted)[: len(coefficients)])
    numbers = (matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2])
    fx, fy, cx, cy = (float(number) for number in numbers)
    best = Lens(fx, fy, cx, cy, lens.width, lens.height, distortion)
    return best, float(np.max(np.ravel(deviations)[:2])) / fx
