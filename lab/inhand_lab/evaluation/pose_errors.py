"""How far poses are from the true ones, by the measures of the field.

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
from inhand_tracker.prior.learning import CHI_SQUARE_90
from inhand_tracker.shape.shape import ObjectShape, Symmetry
from scipy.spatial import KDTree

from inhand_lab.datasets.tracks import Track
from inhand_lab.evaluation.vertex_error import vertex_error

SURFACE_POINTS = 2000
"""That the nearest is searched among, about 3 mm apart on a mug."""
COMPARED_POINTS = 200
"""That are looked at, the first of these."""
CHUNK = 1024
ADD_LIMIT_M = 0.10
CLOSE_M = 0.05
REGULAR = 1e-9
"""Share of the largest variance below which a covariance says nothing of some direction."""
CLOSE_RAD = np.deg2rad(5.0)


@dataclass(frozen=True)
class PoseErrors:
    """Errors of T poses, each (T,), in metres and radians; NaN where a pose is missing."""

    vertex_m: Array
    translation_m: Array
    rotation_rad: Array
    add_m: Array

    def close(self) -> Flags:
        """(T,): which are within 5 cm and 5°."""
        return (self.translation_m < CLOSE_M) & (self.rotation_rad < CLOSE_RAD)

    def area_under_curve(self) -> float:
        """The share of poses within a threshold, averaged over all thresholds up to 10 cm."""
        return float(np.nan_to_num(1.0 - self.add_m / ADD_LIMIT_M).clip(0.0, 1.0).mean())


class ErrorGauge:
    """Compares poses of one object."""

    def __init__(self, shape: ObjectShape) -> None:
        self._shape = shape
        mesh = trimesh.Trimesh(shape.vertices, shape.faces, process=False)
        points, _ = trimesh.sample.sample_surface(mesh, SURFACE_POINTS, seed=0)
        self._compared = np.asarray(points[:COMPARED_POINTS], float)
        self._nearest = KDTree(points) if shape.symmetries else None
        self._centre = np.array(shape.symmetries[0].centre if shape.symmetries else (0.0, 0.0, 0.0))

    def compare(self, estimated: Track, true: Track) -> PoseErrors:
        """The errors of T poses against the true ones."""
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

    def _add(self, estimated: Track, true: Track, between: Array) -> Array:
        """ADD(-S) (T,), in the true object's frame, where the surface stands still."""
        offsets = rotations.rotate(
            rotations.conjugate(true.rotations), estimated.translations - true.translations
        )
        distances = np.full(len(between), np.nan)
        known = np.flatnonzero(np.isfinite(between[:, 0]))
        for start in range(0, len(known), CHUNK):
            some = known[start : start + CHUNK]
            placed = rotations.rotate(between[some, None, :], self._compared)
            placed = placed + offsets[some, None, :]
            if self._nearest is None:
                away = np.linalg.norm(placed - self._compared, axis=-1)
            else:
                away, _ = self._nearest.query(placed)
            distances[some] = away.mean(axis=-1)
        return distances


def region_share(estimated: Track, true: Track, covariances: Array | None) -> float | None:
    """The share of T poses whose 90 % region, by ``covariances`` (T, 6, 6), holds the true pose.

    None where no pose has a covariance that can be inverted.
    """
    if covariances is None:
        return None
    turns = rotations.multiply(estimated.rotations, rotations.conjugate(true.rotations))
    off = np.concatenate(
        (estimated.translations - true.translations, rotations.to_vector(turns)), axis=1
    )
    known = np.flatnonzero(np.isfinite(off).all(axis=1) & np.isfinite(covariances).all(axis=(1, 2)))
    variances = np.linalg.eigvalsh(covariances[known])
    known = known[variances[:, 0] > REGULAR * variances[:, -1]]
    if len(known) == 0:
        return None
    solved = np.linalg.solve(covariances[known], off[known][..., None])[..., 0]
    return float((np.einsum("ti,ti->t", off[known], solved) <= CHI_SQUARE_90).mean())


def least_angle(between: Array, symmetries: tuple[Symmetry, ...]) -> Array:
    """The least angle (...) in radians of rotations (..., 4) in the object's frame.

    Least over the turns that leave the object as it is: products of its discrete symmetries, then
    any turn about an axis of a continuous one.
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
