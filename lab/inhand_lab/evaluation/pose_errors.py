"""Measures the errors of poses against the true ones, as the field does.

- Vertex error: the mean distance of corresponding marked vertices (Darby et al. 2014, section 6.2).
- Translation and rotation apart. For an object with symmetries the rotation is the least one over
  its equal poses, and the translation is that of the symmetries' centre.
- ADD: the mean distance of corresponding points spread over the object's surface (Hinterstoisser et
  al. 2012). For an object with symmetries it is ADD-S, the mean distance to the nearest point.
- The area under the curve of ADD(-S) against its threshold, from 0 to 10 cm (Xiang et al. 2018).
"""

from dataclasses import dataclass

import numpy as np
import trimesh
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.prior.calibration import CHI_SQUARE_90
from inhand_tracker.shape.shape import ObjectShape, Symmetry
from scipy.spatial import KDTree

from inhand_lab.datasets.tracks import Track
from inhand_lab.evaluation.parameters import DEFAULT_EVALUATION, EvaluationParameters
from inhand_lab.evaluation.vertex_error import vertex_error


@dataclass(frozen=True)
class PoseErrors:
    """Errors of T poses, each (T,), in metres and radians; NaN where a pose is missing."""

    vertex_m: Array
    translation_m: Array
    rotation_rad: Array
    add_m: Array

    def close(self, parameters: EvaluationParameters = DEFAULT_EVALUATION) -> Flags:
        """Flag (T,) the poses that are within 5 cm and 5°."""
        return (self.translation_m < parameters.close_m) & (
            self.rotation_rad < parameters.close_rad
        )

    def area_under_curve(self, parameters: EvaluationParameters = DEFAULT_EVALUATION) -> float:
        """Average the share of poses with an ADD(-S) below a threshold over all thresholds."""
        below = np.nan_to_num(1.0 - self.add_m / parameters.add_limit_m)
        return float(below.clip(0.0, 1.0).mean())


class ErrorGauge:
    """Measures the errors of poses of one object."""

    def __init__(
        self, shape: ObjectShape, parameters: EvaluationParameters = DEFAULT_EVALUATION
    ) -> None:
        self._shape = shape
        self._chunk = parameters.chunk
        mesh = trimesh.Trimesh(shape.vertices, shape.faces, process=False)
        points, _ = trimesh.sample.sample_surface(mesh, parameters.surface_points, seed=0)
        self._compared = np.asarray(points[: parameters.compared_points], float)
        self._nearest = KDTree(points) if shape.symmetries else None
        self._centre = np.array(shape.symmetries[0].centre if shape.symmetries else (0.0, 0.0, 0.0))

    def compare(self, estimated: Track, true: Track) -> PoseErrors:
        """Measure the errors of T poses against the true ones."""
        vertex = vertex_error(
            (estimated.translations, estimated.rotations),
            (true.translations, true.rotations),
            self._shape.marked_vertices,
        )
        centres = [
            rotations.rotate(track.rotations, self._centre) + track.translations
            for track in (estimated, true)
        ]
        between = rotations.multiply(rotations.conjugate(true.rotations), estimated.rotations)
        return PoseErrors(
            vertex,
            np.linalg.norm(centres[0] - centres[1], axis=-1),
            least_angle(between, self._shape.symmetries),
            self._add(estimated, true, between),
        )

    def stated_m(self, track: Track) -> Array:
        """Return the deviation of the marked vertices (T,), in metres, that the covariances of T
        poses state, root mean square; NaN where there is none."""
        stated = np.full(len(track.translations), np.nan)
        if track.covariances is not None:
            # A vertex at v from the origin moves by t + w x v of a deviation (t, w).
            arms = rotations.rotate(track.rotations[:, None], self._shape.marked_vertices)
            crosses = np.cross(np.eye(3), -arms[:, :, None], axis=-1)
            moved = np.concatenate(np.broadcast_arrays(np.eye(3), crosses), axis=-2)
            variances = np.einsum("tvai,tab,tvbi->t", moved, track.covariances, moved)
            stated = np.sqrt(np.maximum(variances, 0.0) / len(self._shape.marked_vertices))
        return stated

    def _add(self, estimated: Track, true: Track, between: Array) -> Array:
        """Return ADD(-S) (T,), in the true object's frame, where the surface stands still."""
        offsets = rotations.rotate(
            rotations.conjugate(true.rotations), estimated.translations - true.translations
        )
        distances = np.full(len(between), np.nan)
        given = np.flatnonzero(np.isfinite(between[:, 0]))
        for start in range(0, len(given), self._chunk):
            some = given[start : start + self._chunk]
            placed = rotations.rotate(between[some, None, :], self._compared)
            placed = placed + offsets[some, None, :]
            if self._nearest is None:
                away = np.linalg.norm(placed - self._compared, axis=-1)
            else:
                away, _ = self._nearest.query(placed)
            distances[some] = away.mean(axis=-1)
        return distances


def region_share(
    estimated: Track,
    true: Track,
    covariances: Array | None,
    parameters: EvaluationParameters = DEFAULT_EVALUATION,
) -> float | None:
    """Return the share of T poses whose 90 % region, by ``covariances`` (T, 6, 6), holds the truth.

    None where no pose has a covariance that can be inverted.
    """
    if covariances is None:
        return None
    turns = rotations.multiply(estimated.rotations, rotations.conjugate(true.rotations))
    off = np.concatenate(
        (estimated.translations - true.translations, rotations.to_vector(turns)), axis=1
    )
    given = np.flatnonzero(np.isfinite(off).all(axis=1) & np.isfinite(covariances).all(axis=(1, 2)))
    variances = np.linalg.eigvalsh(covariances[given])
    regular = given[variances[:, 0] > parameters.least_variance_ratio * variances[:, -1]]
    if len(regular) == 0:
        return None
    solved = np.linalg.solve(covariances[regular], off[regular][..., None])[..., 0]
    return float((np.einsum("ti,ti->t", off[regular], solved) <= CHI_SQUARE_90).mean())


def least_angle(between: Array, symmetries: tuple[Symmetry, ...]) -> Array:
    """Return the least angle (...) in radians of rotations (..., 4) in the object's frame.

    It is the least over the turns that leave the object as it is: products of its discrete
    symmetries, then any turn about an axis of a continuous one.
    """
    equal = [between]
    for symmetry in symmetries:
        turns = [_turn(symmetry, step) for step in range(symmetry.order)] or [np.eye(4)[0]]
        equal = [rotations.multiply(one, turn) for one in equal for turn in turns]
    candidates = np.stack(equal)
    # The half angle's cosine; about axis a the best turn φ maximises w cos(φ/2) − (v·a) sin(φ/2).
    cosines = [np.abs(candidates[..., 0])]
    cosines += [
        np.hypot(candidates[..., 0], candidates[..., 1:] @ _unit(symmetry))
        for symmetry in symmetries
        if symmetry.order == 0
    ]
    return 2.0 * np.arccos(np.minimum(np.max(cosines, axis=(0, 1)), 1.0))


def _turn(symmetry: Symmetry, step: int) -> Array:
    return rotations.from_vector(_unit(symmetry) * (2.0 * np.pi * step / symmetry.order))


def _unit(symmetry: Symmetry) -> Array:
    axis = np.array(symmetry.axis)
    return axis / np.linalg.norm(axis)
