"""Bundle adjustment: cameras, boards and clocks that explain all corners best, all at once.

Cameras and clock offsets are few and boards many, so that the boards are eliminated (Schur's
complement; Triggs et al., Bundle adjustment: a modern synthesis, section 6.1).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inhand_calibration.from_board.board import Floats
from inhand_calibration.from_board.lens import Lens
from inhand_calibration.rigid import cross_matrices, moved, turned_by

CAMERA_PARAMETERS = 7
"""Rotation, translation and clock offset."""
BOARD_PARAMETERS = 6


@dataclass(frozen=True)
class AdjustmentParameters:
    """How the adjustment goes on, and what it takes for granted."""

    rounds: int = 60
    """Rounds, at most."""
    settled: float = 1e-9
    """Share of the cost below which a round's gain ends it."""
    tail: float = 3.0
    """Number of deviations from which on the weight of an error falls (Huber's)."""
    cut: float = 5.0
    """Number of deviations from which on a corner counts no longer."""
    clock_prior_s: float = 1.0
    """Deviation of clock offsets beside what was found before: where nothing moves, nothing says
    anything of them."""
    least_deviation_px: float = 0.02
    """Deviation of a corner, pixels, at least."""


DEFAULT_ADJUSTMENT = AdjustmentParameters()


@dataclass(frozen=True)
class Corners3D:
    """Corners seen: K of them, by which camera (K,) at which moment (K,), where on the board (K, 3)
    and in the picture (K, 2), how they moved (K, 2), pixels a second, and how much more they err
    by that, pixels (K,)."""

    camera: NDArray[np.int64]
    moment: NDArray[np.int64]
    place: Floats
    pixel: Floats
    velocity: Floats
    smear: Floats

    def chosen(self, which: NDArray[np.bool_]) -> "Corners3D":
        """Return some of them."""
        return Corners3D(
            self.camera[which],
            self.moment[which],
            self.place[which],
            self.pixel[which],
            self.velocity[which],
            self.smear[which],
        )


@dataclass(frozen=True)
class Bundle:
    """Cameras (C, 4, 4), ``camera_from_reference``; boards (M, 4, 4), ``reference_from_board``;
    and by how much the clocks (C,) are off beside what pixels were taken at, seconds.

    The reference is the first camera's frame and clock. ``fixed`` cameras stay as they are.
    """

    cameras: Floats
    boards: Floats
    clocks: Floats


@dataclass(frozen=True)
class Adjusted:
    """What was adjusted, the errors (K, 2) and deviations (K,) of corners in pixels, which still
    count (K,), and the covariance of the cameras' parameters (7 (C - 1), 7 (C - 1))."""

    bundle: Bundle
    errors: Floats
    deviations: Floats
    counted: NDArray[np.bool_]
    covariance: Floats


def adjust(
    corners: Corners3D,
    lenses: tuple[Lens, ...],
    bundle: Bundle,
    parameters: AdjustmentParameters = DEFAULT_ADJUSTMENT,
) -> Adjusted:
    """Find what explains the corners best, and how much the corners of each camera err."""
    deviations = np.hypot(1.0, corners.smear)
    counted = np.ones(len(corners.camera), bool)
    for stage in range(4):
        bundle = _settled(corners, lenses, bundle, deviations, counted, parameters)
        errors = _errors(corners, lenses, bundle)
        deviations = _deviations(corners, errors, parameters)
        if stage >= 1:
            counted = np.linalg.norm(errors, axis=1) < parameters.cut * deviations
    bundle = _settled(corners, lenses, bundle, deviations, counted, parameters)
    errors = _errors(corners, lenses, bundle)
    covariance = _covariance(corners, lenses, bundle, deviations, counted, parameters)
    return Adjusted(bundle, errors, deviations, counted, covariance)


def _errors(corners: Corners3D, lenses: tuple[Lens, ...], bundle: Bundle) -> Floats:
    """Errors (K, 2), pixels."""
    points = _in_cameras(corners, bundle)
    errors = np.empty_like(corners.pixel)
    for index, lens in enumerate(lenses):
        own = corners.camera == index
        errors[own] = corners.pixel[own] - lens.project(points[own])
    return errors - corners.velocity * bundle.clocks[corners.camera, None]


def _in_cameras(corners: Corners3D, bundle: Bundle) -> Floats:
    """Places of corners (K, 3) in the frames of their cameras."""
    return _through(bundle.cameras[corners.camera], _in_reference(corners, bundle))


def _in_reference(corners: Corners3D, bundle: Bundle) -> Floats:
    return _through(bundle.boards[corners.moment], corners.place)


def _through(transforms: Floats, points: Floats) -> Floats:
    """Take each point (K, 3) through its own transform (K, 4, 4)."""
    return moved(transforms, points[:, None])[:, 0]


def _deviations(corners: Corners3D, errors: Floats, parameters: AdjustmentParameters) -> Floats:
    """Deviation (K,) of each corner: what errors of its camera and of its sight show, with smear.

    A blurred sight errs more than the others of its camera.
    """
    sizes = np.abs(errors).max(axis=1)
    # The larger of two normal errors has a median of 1.052 deviations.
    of_camera = np.ones(len(errors))
    for index in np.unique(corners.camera):
        own = corners.camera == index
        quiet = own & (corners.smear <= np.median(corners.smear[own]))
        of_camera[own] = float(np.median(sizes[quiet])) / 1.052
    least = np.maximum(of_camera, parameters.least_deviation_px)
    deviations = np.hypot(least, corners.smear)
    sights = corners.moment * (int(corners.camera.max()) + 1) + corners.camera
    for sight in np.unique(sights):
        own = sights == sight
        # Of few corners the median errs by half; below twice as much nothing is said.
        seen = float(np.median(sizes[own])) / 1.052
        if seen > 2.0 * float(np.median(deviations[own])):
            deviations[own] = seen
    return deviations


def _settled(
    corners: Corners3D,
    lenses: tuple[Lens, ...],
    bundle: Bundle,
    deviations: Floats,
    counted: NDArray[np.bool_],
    parameters: AdjustmentParameters,
) -> Bundle:
    """Levenberg and Marquardt's descent with Huber's weights, until it settles."""
    damping = 1e-4
    start = bundle.clocks
    cost, weights = _cost(corners, lenses, bundle, deviations, counted, start, parameters)
    for _ in range(parameters.rounds):
        equations = _equations(corners, lenses, bundle, weights, start, parameters)
        while damping < 1e8:
            trial = _stepped(bundle, *equations.step(damping))
            trial_cost, trial_weights = _cost(
                corners, lenses, trial, deviations, counted, start, parameters
            )
            if trial_cost <= cost:
                break
            damping *= 10.0
        else:
            return bundle
        gain = cost - trial_cost
        bundle, cost, weights, damping = trial, trial_cost, trial_weights, damping / 10.0
        if gain <= parameters.settled * cost:
            return bundle
    return bundle


def _cost(
    corners: Corners3D,
    lenses: tuple[Lens, ...],
    bundle: Bundle,
    deviations: Floats,
    counted: NDArray[np.bool_],
    clocks: Floats,
    parameters: AdjustmentParameters,
) -> tuple[float, Floats]:
    """Huber's cost, and the weights (K,) of squared errors in pixels that belong to it."""
    behind = _in_cameras(corners, bundle)[:, 2] < 0.01
    if (behind & counted).any():
        return np.inf, np.zeros(len(counted))
    sizes = np.linalg.norm(_errors(corners, lenses, bundle), axis=1) / deviations
    tail = parameters.tail
    costs = np.where(sizes < tail, 0.5 * sizes**2, tail * (sizes - 0.5 * tail))
    weights = np.where(sizes < tail, 1.0, tail / np.maximum(sizes, tail)) / deviations**2
    prior = 0.5 * float(np.sum(((bundle.clocks - clocks) / parameters.clock_prior_s) ** 2))
    return float(costs[counted].sum()) + prior, np.where(counted, weights, 0.0)


@dataclass(frozen=True)
class _Equations:
    """Normal equations by parts: of cameras (P, P), boards (M, 6, 6), both (M, P, 6)."""

    cameras: Floats
    boards: Floats
    both: Floats
    camera_side: Floats
    board_side: Floats

    def reduced(self, damping: float = 0.0) -> tuple[Floats, Floats, Floats]:
        """Return the cameras' equations with the boards eliminated, their right side, and the
        inverses (M, 6, 6)."""
        inverses = np.linalg.inv(_damped(self.boards, damping))
        gains = self.both @ inverses
        matrix = _damped(self.cameras, damping) - np.einsum("mij,mkj->ik", gains, self.both)
        side = self.camera_side - np.einsum("mij,mj->i", gains, self.board_side)
        return matrix, side, inverses

    def step(self, damping: float) -> tuple[Floats, Floats]:
        """Return by how much cameras (P,) and boards (M, 6) change."""
        matrix, side, inverses = self.reduced(damping)
        cameras = np.linalg.solve(matrix, side) if len(side) else side
        rest = self.board_side - np.einsum("mij,i->mj", self.both, cameras)
        return cameras, np.einsum("mij,mj->mi", inverses, rest)


def _damped(matrices: Floats, damping: float) -> Floats:
    damped = matrices.copy()
    diagonal = np.arange(matrices.shape[-1])
    damped[..., diagonal, diagonal] += damping * matrices[..., diagonal, diagonal] + 1e-12
    return damped


def _equations(
    corners: Corners3D,
    lenses: tuple[Lens, ...],
    bundle: Bundle,
    weights: Floats,
    clocks: Floats,
    parameters: AdjustmentParameters,
) -> _Equations:
    """Build the normal equations from derivatives of the errors."""
    of_cameras, of_boards, errors = _derivatives(corners, lenses, bundle)
    count, moments = len(lenses) - 1, len(bundle.boards)
    size = CAMERA_PARAMETERS * count
    cameras, side = np.zeros((size, size)), np.zeros(size)
    both = np.zeros((moments, size, BOARD_PARAMETERS))
    weighed = weights[:, None, None] * of_boards
    boards = _sums(corners.moment, moments, np.swapaxes(of_boards, 1, 2) @ weighed)
    board_side = _sums(
        corners.moment, moments, (np.swapaxes(weighed, 1, 2) @ errors[:, :, None])[..., 0]
    )
    for index in range(count):
        own = corners.camera == index + 1
        rows = slice(CAMERA_PARAMETERS * index, CAMERA_PARAMETERS * (index + 1))
        slopes = of_cameras[own]
        heavy = weights[own, None, None] * slopes
        cameras[rows, rows] = np.einsum("kri,krj->ij", heavy, slopes)
        side[rows] = np.einsum("kri,kr->i", heavy, errors[own])
        both[:, rows] = _sums(
            corners.moment[own], moments, np.swapaxes(heavy, 1, 2) @ of_boards[own]
        )
        clock = CAMERA_PARAMETERS * index + CAMERA_PARAMETERS - 1
        cameras[clock, clock] += parameters.clock_prior_s**-2
        side[clock] -= (bundle.clocks[index + 1] - clocks[index + 1]) * parameters.clock_prior_s**-2
    return _Equations(cameras, boards, both, side, board_side)


def _derivatives(
    corners: Corners3D, lenses: tuple[Lens, ...], bundle: Bundle
) -> tuple[Floats, Floats, Floats]:
    """Derivatives of predicted pixels by cameras (K, 2, 7) and boards (K, 2, 6), and the errors."""
    turned = np.einsum("kij,kj->ki", bundle.boards[corners.moment, :3, :3], corners.place)
    in_reference = turned + bundle.boards[corners.moment, :3, 3]
    rotations = bundle.cameras[corners.camera, :3, :3]
    lever = np.einsum("kij,kj->ki", rotations, in_reference)
    points = lever + bundle.cameras[corners.camera, :3, 3]
    pixels, slopes = np.empty_like(corners.pixel), np.empty((len(points), 2, 3))
    for index, lens in enumerate(lenses):
        own = corners.camera == index
        if own.any():
            pixels[own], slopes[own] = lens.project_with_slopes(points[own])
    errors = corners.pixel - pixels - corners.velocity * bundle.clocks[corners.camera, None]
    of_cameras = np.concatenate(
        [-slopes @ cross_matrices(lever), slopes, corners.velocity[:, :, None]], axis=2
    )
    by_reference = slopes @ rotations
    of_boards = np.concatenate([-by_reference @ cross_matrices(turned), by_reference], axis=2)
    return of_cameras, of_boards, errors


def _sums(groups: NDArray[np.int64], count: int, values: Floats) -> Floats:
    """Add up values (K, ...) of each of some groups."""
    sums = np.zeros((count, *values.shape[1:]))
    np.add.at(sums, groups, values)
    return sums


def _stepped(bundle: Bundle, cameras: Floats, boards: Floats) -> Bundle:
    """Move cameras and boards by steps of rotation vectors and translations, each on its left."""
    steps = cameras.reshape(-1, CAMERA_PARAMETERS)
    return Bundle(
        np.concatenate([bundle.cameras[:1], _turned(bundle.cameras[1:], steps)]),
        _turned(bundle.boards, boards),
        np.concatenate([bundle.clocks[:1], bundle.clocks[1:] + steps[:, 6]]),
    )


def _turned(transforms: Floats, steps: Floats) -> Floats:
    """Turn about the frame's own origin and shift: the translation itself does not turn."""
    turned = transforms.copy()
    turned[:, :3, :3] = turned_by(steps[:, :3]) @ transforms[:, :3, :3]
    turned[:, :3, 3] += steps[:, 3:6]
    return turned


def _covariance(
    corners: Corners3D,
    lenses: tuple[Lens, ...],
    bundle: Bundle,
    deviations: Floats,
    counted: NDArray[np.bool_],
    parameters: AdjustmentParameters,
) -> Floats:
    """Covariance (P, P) of the cameras' parameters, by the errors that are left.

    Corners of one moment may err together, by a bend or a movement; then moments pull the cameras
    more apart than single corners would, and that is what counts.
    """
    errors = _errors(corners, lenses, bundle)
    weights = np.where(counted, deviations**-2.0, 0.0)
    equations = _equations(corners, lenses, bundle, weights, bundle.clocks, parameters)
    matrix, _, inverses = equations.reduced()
    inverse = np.linalg.inv(matrix)
    moments = len(np.unique(corners.moment[counted]))
    freedom = 2 * int(counted.sum()) - BOARD_PARAMETERS * moments - len(matrix)
    excess = float(np.sum(weights[:, None] * errors**2)) / max(freedom, 1)
    pulls = _pulls(corners, lenses, bundle, weights, equations, inverses)
    # Less than expected is no reason to be surer: movement errs less than it may.
    scales = np.full(len(matrix), max(excess, 1.0))
    for own in _kinds(len(matrix)):
        block = np.linalg.inv(inverse[np.ix_(own, own)])
        steps = (pulls @ inverse)[:, own]
        together = float(np.einsum("mi,ij,mj->", steps, block, steps)) / len(own)
        scales[own] = np.maximum(scales[own], together * moments / max(moments - 1, 1))
    scale = np.sqrt(scales)
    return inverse * scale[:, None] * scale


def _kinds(size: int) -> list[NDArray[np.int64]]:
    """Indices of the parameters of poses, and of those of clocks."""
    numbers = np.arange(size)
    clocks = numbers % CAMERA_PARAMETERS == CAMERA_PARAMETERS - 1
    return [numbers[~clocks], numbers[clocks]] if size else []


def _pulls(
    corners: Corners3D,
    lenses: tuple[Lens, ...],
    bundle: Bundle,
    weights: Floats,
    equations: _Equations,
    inverses: Floats,
) -> Floats:
    """By how much each moment alone pulls the cameras (M, P): they cancel where all settled."""
    of_cameras, _, errors = _derivatives(corners, lenses, bundle)
    moments = len(bundle.boards)
    pulls = np.zeros((moments, len(equations.camera_side)))
    each = weights[:, None] * np.einsum("kri,kr->ki", of_cameras, errors)
    for index in range(len(lenses) - 1):
        own = corners.camera == index + 1
        rows = slice(CAMERA_PARAMETERS * index, CAMERA_PARAMETERS * (index + 1))
        pulls[:, rows] = _sums(corners.moment[own], moments, each[own])
    return pulls - np.einsum("mij,mjk,mk->mi", equations.both, inverses, equations.board_side)
