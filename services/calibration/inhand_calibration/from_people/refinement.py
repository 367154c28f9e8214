"""Refines all cameras' poses, clocks and biases together, and says how sure they are.

The residuals are the differences of the same joint at the same moment between two cameras, for
every two. Their weights are those of a Student distribution (Lange, Little & Taylor 1989). The
covariance is a sandwich with clusters by joint and by block of time (Cameron, Gelbach & Miller
2011, the sum of both without the difference that may be negative): a joint that is read wrongly
alike for the whole time, and a whole body that is read wrongly for a while, both count.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from inhand_schemas.joints import Joint
from scipy.spatial.transform import Rotation

from inhand_calibration.arrays import Array, Flags, Indices
from inhand_calibration.from_people.agreement import Agreement, find_agreement
from inhand_calibration.from_people.estimate import CameraEstimate
from inhand_calibration.from_people.parameters import PeopleCalibrationParameters
from inhand_calibration.from_people.tracks import Observed, Track, observe

POSE, CLOCK, OF_CAMERA = 6, 2, 9
"""Numbers of a camera: translation and rotation vector, offset and drift, and the surface."""
_OFFSET, _DRIFT, _SURFACE = 6, 7, 8
_NORMAL_NORM = 1.538
"""Median length of a vector of three standard normal numbers."""


@dataclass(frozen=True)
class EstimatePrior:
    """What is known before of a camera's pose in the reference's frame: a Gaussian.

    ``covariance`` (6, 6) is of translation and rotation vector along the reference's axes.
    """

    mean: CameraEstimate
    covariance: Array


@dataclass(frozen=True)
class Refined:
    """The estimates of C cameras, the reference first, and their covariance (9 C, 9 C).

    A camera has translation, rotation vector (along the reference's axes), offset, drift and
    surface in it. ``agreements`` are those of each two cameras by their places.
    """

    estimates: tuple[CameraEstimate, ...]
    covariance: Array
    times: Array
    agreements: Mapping[tuple[int, int], Agreement]

    def covariance_of(self, camera: int) -> Array:
        """Return the covariance (9, 9) of one camera."""
        own = slice(OF_CAMERA * camera, OF_CAMERA * (camera + 1))
        return self.covariance[own, own]


@dataclass(frozen=True)
class _Residuals:
    """Residuals of one pair of cameras: differences (M, 20, 3), their derivatives
    (M, 20, 3, 18) by the numbers of both cameras, and supports (M, 20)."""

    differences: Array
    derivatives: Array
    support: Array
    blocks: Indices


def refine(
    tracks: Sequence[Sequence[Track]],
    estimates: Sequence[CameraEstimate],
    parameters: PeopleCalibrationParameters,
    priors: Mapping[int, EstimatePrior] | None = None,
) -> Refined:
    """Refine C cameras' estimates, the first of which is the reference, by their movements."""
    times = _moments(tracks, estimates, parameters)
    middle = float(times.mean()) if len(times) else 0.0
    current = [replace(estimate, middle=middle) for estimate in estimates]
    free = _free(len(current))
    for _ in range(parameters.refinement.iterations):
        agreements = agree(tracks, current, times, parameters)
        information, push, _ = _normal(agreements, current, times, parameters, priors or {})
        step = np.zeros(len(free))
        step[free] = np.linalg.solve(information[np.ix_(free, free)], push[free])
        current = [_moved(e, step[_own(camera)]) for camera, e in enumerate(current)]
        if np.abs(step).max() < parameters.refinement.rest_step:
            break
    agreements = agree(tracks, current, times, parameters)
    information, _, scatter = _normal(agreements, current, times, parameters, priors or {})
    covariance = np.zeros_like(information)
    inverse = np.linalg.inv(information[np.ix_(free, free)])
    covariance[np.ix_(free, free)] = inverse @ scatter[np.ix_(free, free)] @ inverse
    return Refined(tuple(current), covariance, times, agreements)


def agree(
    tracks: Sequence[Sequence[Track]],
    estimates: Sequence[CameraEstimate],
    times: Array,
    parameters: PeopleCalibrationParameters,
) -> dict[tuple[int, int], Agreement]:
    """Return the agreement of each two cameras at times (K,) of the reference."""
    observed: list[Observed] = [
        observe(own, estimate.camera_times(times))
        for own, estimate in zip(tracks, estimates, strict=True)
    ]
    return {
        (first, second): find_agreement(
            (observed[first], estimates[first]),
            (observed[second], estimates[second]),
            parameters.agreement,
        )
        for first, second in combinations(range(len(tracks)), 2)
    }


def _moments(
    tracks: Sequence[Sequence[Track]],
    estimates: Sequence[CameraEstimate],
    parameters: PeopleCalibrationParameters,
) -> Array:
    """Times of the reference at which anybody may be seen by two cameras."""
    offsets = [estimate.offset for estimate in estimates]
    starts = sorted(min(t.start for t in own) + o for own, o in zip(tracks, offsets, strict=True))
    ends = sorted(max(t.end for t in own) + o for own, o in zip(tracks, offsets, strict=True))
    return np.arange(starts[1], ends[-2], parameters.agreement.step_s)


def _free(cameras: int) -> Flags:
    """Which of the numbers (9 C,) are estimated: of the reference only its surface."""
    free = np.ones(OF_CAMERA * cameras, bool)
    free[:_SURFACE] = False
    return free


def _own(camera: int) -> slice:
    return slice(OF_CAMERA * camera, OF_CAMERA * (camera + 1))


def _moved(estimate: CameraEstimate, step: Array) -> CameraEstimate:
    turn = Rotation.from_rotvec(step[3:POSE]).as_matrix()
    return replace(
        estimate,
        rotation=turn @ estimate.rotation,
        translation=estimate.translation + step[:3],
        offset=estimate.offset + float(step[_OFFSET]),
        drift=estimate.drift + float(step[_DRIFT]),
        surface=estimate.surface + float(step[_SURFACE]),
    )


def _normal(
    agreements: Mapping[tuple[int, int], Agreement],
    estimates: Sequence[CameraEstimate],
    times: Array,
    parameters: PeopleCalibrationParameters,
    priors: Mapping[int, EstimatePrior],
) -> tuple[Array, Array, Array]:
    """Information (9 C, 9 C), push (9 C,) towards the best, and the scatter of pushes by clusters
    (9 C, 9 C)."""
    size = OF_CAMERA * len(estimates)
    information, push = _known_before(estimates, parameters, priors)
    scatter = information.copy()
    residuals = {
        pair: _residuals(agreement, [estimates[c] for c in pair], times, parameters)
        for pair, agreement in agreements.items()
    }
    deviations = _deviations(list(residuals.values()), parameters)
    blocks = int(max((r.blocks.max(initial=0) for r in residuals.values()), default=0)) + 1
    by_joint, by_block = np.zeros((len(Joint), size)), np.zeros((blocks, size))
    for (first, second), residual in residuals.items():
        columns = np.r_[_own(first), _own(second)]
        weights = _weights(residual, deviations, parameters)
        weighted = residual.derivatives * weights[..., None, None]
        flat = weighted.reshape(-1, len(columns))
        information[np.ix_(columns, columns)] += flat.T @ residual.derivatives.reshape(flat.shape)
        pushes = -np.einsum("mjxp,mjx->mjp", weighted, residual.differences)
        push[columns] += pushes.sum(axis=(0, 1))
        by_joint[:, columns] += pushes.sum(axis=0)
        np.add.at(by_block, (residual.blocks[:, None], columns[None]), pushes.sum(axis=1))
    for clusters in (by_joint, by_block):
        used = int((clusters != 0.0).any(axis=1).sum())
        factor = parameters.refinement.covariance_factor * used / max(used - 1, 1)
        scatter += factor * clusters.T @ clusters
    return information, push, scatter


def _known_before(
    estimates: Sequence[CameraEstimate],
    parameters: PeopleCalibrationParameters,
    priors: Mapping[int, EstimatePrior],
) -> tuple[Array, Array]:
    """Information and push of what is known before: drifts, surfaces, and poses with a prior."""
    count = len(estimates)
    information = np.zeros((OF_CAMERA * count, OF_CAMERA * count))
    push = np.zeros(OF_CAMERA * count)
    drifts = OF_CAMERA * np.arange(1, count) + _DRIFT
    information[drifts, drifts] = (1e6 / parameters.refinement.drift_ppm) ** 2
    push[drifts] = -information[drifts, drifts] * [e.drift for e in estimates[1:]]
    surfaces = OF_CAMERA * np.arange(count) + _SURFACE
    common, own = parameters.refinement.surface_m, parameters.refinement.surface_difference_m
    block = np.linalg.inv(common**2 * np.ones((count, count)) + own**2 * np.eye(count))
    information[np.ix_(surfaces, surfaces)] += block
    push[surfaces] -= block @ [e.surface for e in estimates]
    for camera, prior in priors.items():
        pose = slice(OF_CAMERA * camera, OF_CAMERA * camera + POSE)
        mean = prior.mean
        turn = Rotation.from_matrix(estimates[camera].rotation @ mean.rotation.T).as_rotvec()
        off = np.concatenate([estimates[camera].translation - mean.translation, turn])
        known = np.linalg.inv(prior.covariance)
        information[pose, pose] += known
        push[pose] -= known @ off
    return information, push


def _residuals(
    agreement: Agreement,
    estimates: Sequence[CameraEstimate],
    times: Array,
    parameters: PeopleCalibrationParameters,
) -> _Residuals:
    at = times[agreement.moments]
    sides = []
    for observed, estimate in zip((agreement.first, agreement.second), estimates, strict=True):
        turned = observed.positions @ estimate.rotation.T
        away = turned / np.maximum(np.linalg.norm(turned, axis=2, keepdims=True), 1e-6)
        velocity = observed.velocities @ estimate.rotation.T
        derivatives = np.zeros((*turned.shape, OF_CAMERA))
        derivatives[..., :3] = np.eye(3)
        # (turn × point) = −[point]× turn
        x, y, z = np.moveaxis(turned, -1, 0)
        derivatives[..., 0, 4], derivatives[..., 0, 5] = z, -y
        derivatives[..., 1, 3], derivatives[..., 1, 5] = -z, x
        derivatives[..., 2, 3], derivatives[..., 2, 4] = y, -x
        derivatives[..., _OFFSET] = -velocity
        derivatives[..., _DRIFT] = -velocity * (at - estimate.middle)[:, None, None]
        derivatives[..., _SURFACE] = away
        place = turned + estimate.translation + estimate.surface * away
        sides.append((place, derivatives))
    (own, by_own), (other, by_other) = sides
    return _Residuals(
        own - other,
        np.concatenate([by_own, -by_other], axis=-1),
        np.sqrt(agreement.first.support * agreement.second.support),
        ((at - times[0]) / parameters.refinement.block_s).astype(np.int64),
    )


def _deviations(residuals: Sequence[_Residuals], parameters: PeopleCalibrationParameters) -> Array:
    """Deviation (20,) of each joint's residuals along an axis, metres."""
    lengths = np.concatenate([np.linalg.norm(r.differences, axis=2) for r in residuals])
    known = np.concatenate([r.support for r in residuals]) > 0.0
    medians = [np.median(lengths[known[:, j], j]) if known[:, j].any() else 1.0 for j in Joint]
    return np.maximum(np.array(medians) / _NORMAL_NORM, parameters.refinement.least_deviation_m)


def _weights(
    residual: _Residuals, deviations: Array, parameters: PeopleCalibrationParameters
) -> Array:
    """Weight (M, 20) of each joint, 1/m²: its information, and how far it is to be believed."""
    freedom = parameters.refinement.freedom
    squares = np.sum(residual.differences**2, axis=2) / deviations**2
    believed = (freedom + 3.0) / (freedom + squares)
    support = residual.support / max(residual.support.max(initial=0.0), 1e-9)
    return np.asarray(support * believed / deviations**2)
