"""Bundle adjustment: cameras, boards and clocks that explain all corners best, all at once.

Cameras and clock offsets are few and boards many, so that the boards are eliminated (Schur's
complement; Triggs et al., Bundle adjustment: a modern synthesis, section 6.1).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inhand_calibration.arrays import Array
from inhand_calibration.from_board.lens import Lens
from inhand_calibration.rigid import cross_matrices, moved, turned_by

CAMERA_PARAMETERS = 10
"""Rotation, translation, clock offset, change of the focal length (a share of it), and shift of the
principal point."""
POSE, CLOCK, LENS = slice(0, 6), 6, slice(7, 10)
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
    focal_prior: float = 0.05
    """Deviation of focal lengths from those that are published, a share of them, where they are
    adjusted too."""
    centre_prior: float = 0.05
    """The same of principal points, a share of the picture's width."""
    alike: float = 2.5
    """Factor on covariances, since corners of a picture err alike, by light, blur and pixels:
    as drawn views showed, checked on others by `inhand bench calibration`;
    1 where their errors are independent."""
    least_deviation_px: float = 0.02
    """Deviation of a corner, pixels, at least."""


DEFAULT_ADJUSTMENT = AdjustmentParameters()


@dataclass(frozen=True)
class Corners3D:
    """Corners seen: K of them, by which camera (K,) at which moment (K,), where on the board (K, 3)
    and in the picture (K, 2), how they moved (K, 2), pixels a second, how much more they err by
    that, pixels (K,), and the noise of them against that of others of the camera (K,)."""

    camera: NDArray[np.int64]
    moment: NDArray[np.int64]
    place: Array
    pixel: Array
    velocity: Array
    smear: Array
    noise: Array


@dataclass(frozen=True)
class Bundle:
    """Cameras (C, 4, 4), ``camera_from_reference``; boards (M, 4, 4), ``reference_from_board``;
    by how much the clocks (C,) are off beside what pixels were taken at, seconds; and by how much
    the lenses (C, 3) are other than published, as ``Lens.changed`` takes it.

    The reference is the first camera's frame and clock.
    """

    cameras: Array
    boards: Array
    clocks: Array
    lenses: Array


@dataclass(frozen=True)
class Adjusted:
    """What was adjusted, the errors (K, 2) and deviations (K,) of corners in pixels, which still
    count (K,), and the covariance of the cameras' parameters (10 C, 10 C), 0 of what was fixed."""

    bundle: Bundle
    errors: Array
    deviations: Array
    counted: NDArray[np.bool_]
    covariance: Array


def adjust(
    corners: Corners3D,
    lenses: tuple[Lens, ...],
    bundle: Bundle,
    parameters: AdjustmentParameters = DEFAULT_ADJUSTMENT,
    *,
    with_lenses: bool = False,
) -> Adjusted:
    """Find what explains the corners best, and how much the corners of each camera err.

    The first camera and its clock are fixed, and so are lenses but ``with_lenses``.
    """
    problem = Problem(corners, lenses, _free(len(lenses), with_lenses=with_lenses), parameters)
    deviations = np.hypot(corners.noise, corners.smear)
    counted = np.ones(len(corners.camera), bool)
    for stage in range(4):
        bundle = _settled(problem, bundle, deviations, counted)
        errors = _errors(problem, bundle)
        deviations = _deviations(corners, errors, parameters)
        if stage >= 1:
            counted = np.linalg.norm(errors, axis=1) < parameters.cut * deviations
    bundle = _settled(problem, bundle, deviations, counted)
    errors = _errors(problem, bundle)
    covariance = _covariance(problem, bundle, deviations, counted)
    return Adjusted(bundle, errors, deviations, counted, covariance)


@dataclass(frozen=True)
class Problem:
    """What is adjusted by what: ``free`` are the numbers of the cameras' parameters that are."""

    corners: Corners3D
    lenses: tuple[Lens, ...]
    free: NDArray[np.int64]
    parameters: AdjustmentParameters

    def changed_lenses(self, bundle: Bundle) -> list[Lens]:
        """Return the lenses as a bundle has them."""
        return [
            lens.changed(*(float(one) for one in change))
            for lens, change in zip(self.lenses, bundle.lenses, strict=True)
        ]

    @property
    def information(self) -> Array:
        """What is known of the cameras' parameters (10 C,) before: inverse variances."""
        known = np.zeros((len(self.lenses), CAMERA_PARAMETERS))
        known[:, CLOCK] = self.parameters.clock_prior_s**-2
        known[:, LENS.start] = self.parameters.focal_prior**-2
        for index, lens in enumerate(self.lenses):
            known[index, LENS.start + 1 :] = (self.parameters.centre_prior * lens.width) ** -2
        return known.ravel()

    def strayed(self, bundle: Bundle) -> Array:
        """By how much the cameras' parameters (10 C,) differ from what was known before."""
        strayed = np.zeros((len(self.lenses), CAMERA_PARAMETERS))
        strayed[:, CLOCK] = bundle.clocks
        strayed[:, LENS] = bundle.lenses
        return strayed.ravel()


def _free(cameras: int, *, with_lenses: bool) -> NDArray[np.int64]:
    free = np.zeros((cameras, CAMERA_PARAMETERS), bool)
    free[1:, : CLOCK + 1] = True
    free[:, LENS] = with_lenses
    return np.flatnonzero(free)


def _errors(problem: Problem, bundle: Bundle) -> Array:
    """Errors (K, 2), pixels."""
    corners = problem.corners
    points = _in_cameras(corners, bundle)
    errors = np.empty_like(corners.pixel)
    for index, lens in enumerate(problem.changed_lenses(bundle)):
        own = corners.camera == index
        errors[own] = corners.pixel[own] - lens.project(points[own])
    return errors - corners.velocity * bundle.clocks[corners.camera, None]


def _in_cameras(corners: Corners3D, bundle: Bundle) -> Array:
    """Places of corners (K, 3) in the frames of their cameras."""
    return _through(bundle.cameras[corners.camera], _in_reference(corners, bundle))


def _in_reference(corners: Corners3D, bundle: Bundle) -> Array:
    return _through(bundle.boards[corners.moment], corners.place)


def _through(transforms: Array, points: Array) -> Array:
    """Take each point (K, 3) through its own transform (K, 4, 4)."""
    return moved(transforms, points[:, None])[:, 0]


def _deviations(corners: Corners3D, errors: Array, parameters: AdjustmentParameters) -> Array:
    """Deviation (K,) of each corner: what errors of its camera and of its sight show, with smear.

    A blurred sight errs more than the others of its camera.
    """
    sizes = np.abs(errors).max(axis=1)
    # The larger of two normal errors has a median of 1.052 deviations.
    of_camera = np.ones(len(errors))
    for index in np.unique(corners.camera):
        own = corners.camera == index
        quiet = own & (corners.smear <= np.median(corners.smear[own]))
        of_camera[own] = float(np.median(sizes[quiet] / corners.noise[quiet])) / 1.052
    least = np.maximum(of_camera * corners.noise, parameters.least_deviation_px)
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
    problem: Problem, bundle: Bundle, deviations: Array, counted: NDArray[np.bool_]
) -> Bundle:
    """Levenberg and Marquardt's descent with Huber's weights, until it settles."""
    damping = 1e-4
    cost, weights = _cost(problem, bundle, deviations, counted)
    for _ in range(problem.parameters.rounds):
        equations = _equations(problem, bundle, weights)
        while damping < 1e8:
            trial = _stepped(problem, bundle, *equations.step(damping))
            trial_cost, trial_weights = _cost(problem, trial, deviations, counted)
            if trial_cost <= cost:
                break
            damping *= 10.0
        else:
            return bundle
        gain = cost - trial_cost
        bundle, cost, weights, damping = trial, trial_cost, trial_weights, damping / 10.0
        if gain <= problem.parameters.settled * cost:
            return bundle
    return bundle


def _cost(
    problem: Problem, bundle: Bundle, deviations: Array, counted: NDArray[np.bool_]
) -> tuple[float, Array]:
    """Huber's cost, and the weights (K,) of squared errors in pixels that belong to it."""
    behind = _in_cameras(problem.corners, bundle)[:, 2] < 0.01
    if (behind & counted).any():
        return np.inf, np.zeros(len(counted))
    sizes = np.linalg.norm(_errors(problem, bundle), axis=1) / deviations
    tail = problem.parameters.tail
    costs = np.where(sizes < tail, 0.5 * sizes**2, tail * (sizes - 0.5 * tail))
    weights = np.where(sizes < tail, 1.0, tail / np.maximum(sizes, tail)) / deviations**2
    prior = 0.5 * float(np.sum(problem.information * problem.strayed(bundle) ** 2))
    return float(costs[counted].sum()) + prior, np.where(counted, weights, 0.0)


@dataclass(frozen=True)
class _Equations:
    """Normal equations by parts: of cameras (P, P), boards (M, 6, 6), both (M, P, 6)."""

    cameras: Array
    boards: Array
    both: Array
    camera_side: Array
    board_side: Array

    def reduced(self, damping: float = 0.0) -> tuple[Array, Array, Array]:
        """Return the cameras' equations with the boards eliminated, their right side, and the
        inverses (M, 6, 6)."""
        inverses: Array = np.linalg.inv(_damped(self.boards, damping)).astype(float)
        gains = self.both @ inverses
        matrix: Array = _damped(self.cameras, damping) - np.einsum("mij,mkj->ik", gains, self.both)
        side: Array = self.camera_side - np.einsum("mij,mj->i", gains, self.board_side)
        return matrix, side, inverses

    def step(self, damping: float) -> tuple[Array, Array]:
        """Return by how much cameras (P,) and boards (M, 6) change."""
        matrix, side, inverses = self.reduced(damping)
        cameras = np.linalg.solve(matrix, side).astype(float) if len(side) else side
        rest = self.board_side - np.einsum("mij,i->mj", self.both, cameras)
        boards: Array = np.einsum("mij,mj->mi", inverses, rest)
        return cameras, boards


def _damped(matrices: Array, damping: float) -> Array:
    damped = matrices.copy()
    diagonal = np.arange(matrices.shape[-1])
    damped[..., diagonal, diagonal] += damping * matrices[..., diagonal, diagonal] + 1e-12
    return damped


def _equations(problem: Problem, bundle: Bundle, weights: Array) -> _Equations:
    """Build the normal equations from derivatives of the errors."""
    corners, moments = problem.corners, len(bundle.boards)
    of_cameras, of_boards, errors = _derivatives(problem, bundle)
    size = CAMERA_PARAMETERS * len(problem.lenses)
    cameras = np.diag(problem.information)
    side = -problem.information * problem.strayed(bundle)
    both = np.zeros((moments, size, BOARD_PARAMETERS))
    weighed = weights[:, None, None] * of_boards
    boards = _sums(corners.moment, moments, np.swapaxes(of_boards, 1, 2) @ weighed)
    board_side = _sums(
        corners.moment, moments, (np.swapaxes(weighed, 1, 2) @ errors[:, :, None])[..., 0]
    )
    for index in range(len(problem.lenses)):
        own = corners.camera == index
        rows = _rows(index)
        slopes = of_cameras[own]
        heavy = weights[own, None, None] * slopes
        cameras[rows, rows] += np.einsum("kri,krj->ij", heavy, slopes)
        side[rows] += np.einsum("kri,kr->i", heavy, errors[own])
        both[:, rows] = _sums(
            corners.moment[own], moments, np.swapaxes(heavy, 1, 2) @ of_boards[own]
        )
    free = problem.free
    return _Equations(cameras[np.ix_(free, free)], boards, both[:, free], side[free], board_side)


def _rows(camera: int) -> slice:
    """Where a camera's parameters stand among those of all."""
    return slice(CAMERA_PARAMETERS * camera, CAMERA_PARAMETERS * (camera + 1))


def _derivatives(problem: Problem, bundle: Bundle) -> tuple[Array, Array, Array]:
    """Derivatives of pixels by cameras (K, 2, 10) and boards (K, 2, 6), and the errors (K, 2)."""
    corners = problem.corners
    turned = np.einsum("kij,kj->ki", bundle.boards[corners.moment, :3, :3], corners.place)
    in_reference = turned + bundle.boards[corners.moment, :3, 3]
    rotations = bundle.cameras[corners.camera, :3, :3]
    lever = np.einsum("kij,kj->ki", rotations, in_reference)
    points = lever + bundle.cameras[corners.camera, :3, 3]
    pixels, slopes = np.empty_like(corners.pixel), np.empty((len(points), 2, 3))
    of_lenses = np.zeros((len(points), 2, 3))
    of_lenses[:, 0, 1] = of_lenses[:, 1, 2] = 1.0
    for index, lens in enumerate(problem.changed_lenses(bundle)):
        own = corners.camera == index
        if own.any():
            pixels[own], slopes[own] = lens.project_with_slopes(points[own])
            share = 1.0 + bundle.lenses[index, 0]
            of_lenses[own, :, 0] = (pixels[own] - [lens.cx, lens.cy]) / share
    errors = corners.pixel - pixels - corners.velocity * bundle.clocks[corners.camera, None]
    of_cameras = np.concatenate(
        [-slopes @ cross_matrices(lever), slopes, corners.velocity[:, :, None], of_lenses], axis=2
    )
    by_reference = slopes @ rotations
    of_boards = np.concatenate([-by_reference @ cross_matrices(turned), by_reference], axis=2)
    return of_cameras, of_boards, errors


def _sums(groups: NDArray[np.int64], count: int, values: Array) -> Array:
    """Add up values (K, ...) of each of some groups."""
    sums = np.zeros((count, *values.shape[1:]))
    np.add.at(sums, groups, values)
    return sums


def _stepped(problem: Problem, bundle: Bundle, cameras: Array, boards: Array) -> Bundle:
    """Move cameras and boards by steps of rotation vectors and translations, each on its left."""
    every = np.zeros(CAMERA_PARAMETERS * len(problem.lenses))
    every[problem.free] = cameras
    steps = every.reshape(-1, CAMERA_PARAMETERS)
    return Bundle(
        _turned(bundle.cameras, steps[:, POSE]),
        _turned(bundle.boards, boards),
        bundle.clocks + steps[:, CLOCK],
        bundle.lenses + steps[:, LENS],
    )


def _turned(transforms: Array, steps: Array) -> Array:
    """Turn about the frame's own origin and shift: the translation itself does not turn."""
    turned = transforms.copy()
    turned[:, :3, :3] = turned_by(steps[:, :3]) @ transforms[:, :3, :3]
    turned[:, :3, 3] += steps[:, 3:6]
    return turned


def _covariance(
    problem: Problem, bundle: Bundle, deviations: Array, counted: NDArray[np.bool_]
) -> Array:
    """Covariance (10 C, 10 C) of the cameras' parameters, by the errors that are left.

    Corners of one moment may err together, by a bend or a movement; then moments pull the cameras
    more apart than single corners would, and that is what counts.
    """
    errors = _errors(problem, bundle)
    weights = np.where(counted, deviations**-2.0, 0.0)
    equations = _equations(problem, bundle, weights)
    matrix, _, inverses = equations.reduced()
    inverse = np.linalg.inv(matrix)
    moments = len(np.unique(problem.corners.moment[counted]))
    freedom = 2 * int(counted.sum()) - BOARD_PARAMETERS * moments - len(matrix)
    excess = float(np.sum(weights[:, None] * errors**2)) / max(freedom, 1)
    pulls = _pulls(problem, bundle, weights, equations, inverses)
    # Less than expected is no reason to be surer: movement errs less than it may.
    scales = np.full(len(matrix), max(excess, 1.0))
    for own in _kinds(problem.free):
        block = np.linalg.inv(inverse[np.ix_(own, own)])
        steps = (pulls @ inverse)[:, own]
        together = float(np.einsum("mi,ij,mj->", steps, block, steps)) / len(own)
        scales[own] = np.maximum(scales[own], together * moments / max(moments - 1, 1))
    scale = np.sqrt(problem.parameters.alike * scales)
    size = CAMERA_PARAMETERS * len(problem.lenses)
    every = np.zeros((size, size))
    every[np.ix_(problem.free, problem.free)] = inverse * scale[:, None] * scale
    return every


def _kinds(free: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """Places among free parameters of those of clocks, and of all others."""
    clocks = free % CAMERA_PARAMETERS == CLOCK
    kinds = [np.flatnonzero(~clocks), np.flatnonzero(clocks)]
    return [kind for kind in kinds if len(kind)]


def _pulls(
    problem: Problem, bundle: Bundle, weights: Array, equations: _Equations, inverses: Array
) -> Array:
    """By how much each moment alone pulls the cameras (M, P): they cancel where all settled."""
    corners, moments = problem.corners, len(bundle.boards)
    of_cameras, _, errors = _derivatives(problem, bundle)
    pulls = np.zeros((moments, CAMERA_PARAMETERS * len(problem.lenses)))
    each = weights[:, None] * np.einsum("kri,kr->ki", of_cameras, errors)
    for index in range(len(problem.lenses)):
        own = corners.camera == index
        pulls[:, _rows(index)] = _sums(corners.moment[own], moments, each[own])
    return pulls[:, problem.free] - np.einsum(
        "mij,mjk,mk->mi", equations.both, inverses, equations.board_side
    )
