"""Variation, stability and proximity over the clusters of a sequence (Darby et al. 2014, TR2, TR3).

All clusters of a stretch are summed up at once: a matrix of which frames belong to which cluster,
times what is summed. Only the rotations' variation needs every frame of every cluster by itself.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.spatial.distance import cdist

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Flags, Indices
from inhand_tracker.mapping.mapping import stretches

_ROWS, _COLUMNS = np.triu_indices(4)


@dataclass(frozen=True)
class RelativePoses:
    """TR1 of a sequence: ``body_poses`` b (N, 60), and the object relative to each part, in body
    heights, ``translations`` (N, 19, 3) and ``rotations`` (N, 19, 4).

    ``consecutive`` (N,) is true where the next row is the next frame.
    """

    body_poses: Array
    translations: Array
    rotations: Array
    consecutive: Flags

    @staticmethod
    def empty(frames: int) -> "RelativePoses":
        """Room for a number of frames."""
        return RelativePoses(
            np.empty((frames, 60)),
            np.empty((frames, 19, 3)),
            np.empty((frames, 19, 4)),
            np.empty(frames, np.bool_),
        )

    def rows(self, rows: slice) -> "RelativePoses":
        """Some frames, without a copy."""
        return RelativePoses(
            self.body_poses[rows],
            self.translations[rows],
            self.rotations[rows],
            self.consecutive[rows],
        )

    def put(self, rows: slice, poses: "RelativePoses") -> None:
        """Write some frames."""
        self.body_poses[rows] = poses.body_poses
        self.translations[rows] = poses.translations
        self.rotations[rows] = poses.rotations
        self.consecutive[rows] = poses.consecutive


@dataclass(frozen=True)
class Measures:
    """What is measured of a stretch's frames, each (N,): φᵉ, φᶿ, and the parts of least ψᵉ, ψᶿ and
    ψ'ᵉ."""

    translation_variation: Array
    rotation_variation: Array
    stable_translation_part: Indices
    stable_rotation_part: Indices
    proximate_part: Indices

    @staticmethod
    def empty(frames: int) -> "Measures":
        """Room for a number of frames."""
        variations, parts = np.empty((2, frames)), np.empty((3, frames), np.int64)
        return Measures(*variations, *parts)

    def put(self, rows: slice, measures: "Measures") -> None:
        """Write some frames."""
        self.translation_variation[rows] = measures.translation_variation
        self.rotation_variation[rows] = measures.rotation_variation
        self.stable_translation_part[rows] = measures.stable_translation_part
        self.stable_rotation_part[rows] = measures.stable_rotation_part
        self.proximate_part[rows] = measures.proximate_part


def measure_sequence(
    poses: RelativePoses, radius: float, longest_stretch: int
) -> Iterator[tuple[slice, Measures]]:
    """The measures of a sequence's frames, a stretch at a time, with the rows they are of.

    ``radius`` is the sequence's δ.
    """
    steps = _Steps.of(poses)
    for start, end in pairwise(stretches(len(poses.body_poses), longest_stretch).tolist()):
        yield slice(start, end), _measure_stretch(poses, steps, slice(start, end), radius)


@dataclass(frozen=True)
class _Steps:
    """Steps of the object relative to each part from a frame to the next: ``translations`` and
    ``rotations`` (N, 19), and ``consecutive`` (N,), whether the next row is the next frame.

    The last frame has the step that leads to it.
    """

    translations: Array
    rotations: Array
    consecutive: Flags

    @staticmethod
    def of(poses: RelativePoses) -> "_Steps":
        moved = np.linalg.norm(np.diff(poses.translations, axis=0), axis=-1)
        turned = rotations.separation(poses.rotations[:-1], poses.rotations[1:])
        return _Steps(
            np.concatenate((moved, moved[-1:])),
            np.concatenate((turned, turned[-1:])),
            poses.consecutive,
        )


def _measure_stretch(poses: RelativePoses, steps: _Steps, rows: slice, radius: float) -> Measures:
    body_poses, translations = poses.body_poses[rows], poses.translations[rows]
    orientations = poses.rotations[rows]
    near = cdist(body_poses, body_poses) <= radius
    clusters = near.astype(np.float64)
    sizes = clusters.sum(axis=1)

    moved, turned = steps.translations[rows], steps.rotations[rows]
    has_step = steps.consecutive[rows, None]
    moves, turns = clusters @ (moved * has_step), clusters @ (turned * has_step)
    # A cluster without any step is judged by the frame's own, across the gap.
    alone = ~near[:, steps.consecutive[rows]].any(axis=1, keepdims=True)
    distances = np.linalg.norm(translations, axis=-1)
    return Measures(
        _translation_variation(clusters, sizes, translations),
        _rotation_variation(near, clusters, sizes, orientations),
        np.argmin(np.where(alone, moved, moves), axis=1),
        np.argmin(np.where(alone, turned, turns), axis=1),
        np.argmin(clusters @ distances, axis=1),
    )


def _translation_variation(clusters: Array, sizes: Array, translations: Array) -> Array:
    """φᵉ (n,): the median over the parts of the mean squared distance from the cluster's mean."""
    offsets = translations - translations.mean(axis=0)
    count = len(offsets)
    means = (clusters @ offsets.reshape(count, -1)).reshape(offsets.shape) / sizes[:, None, None]
    squares = clusters @ np.square(offsets).sum(axis=-1) / sizes[:, None]
    variations = squares - np.square(means).sum(axis=-1)
    return np.median(np.maximum(variations, 0.0), axis=1)


def _rotation_variation(near: Flags, clusters: Array, sizes: Array, orientations: Array) -> Array:
    """φᶿ (n,): the median over the parts of the mean squared θ from the cluster's mean."""
    count, parts = orientations.shape[:2]
    products = orientations[..., _ROWS] * orientations[..., _COLUMNS]
    sums = (clusters @ products.reshape(count, -1)).reshape(products.shape)
    scatter = np.empty((count, parts, 4, 4))
    scatter[..., _ROWS, _COLUMNS] = scatter[..., _COLUMNS, _ROWS] = sums
    means = rotations.principal(scatter)
    first_members = np.concatenate(([0], np.cumsum(sizes[:-1]))).astype(np.intp)
    variations = np.empty((count, parts))
    for part in range(parts):
        cosines = np.abs(means[:, part] @ orientations[:, part].T)[near]
        squares = np.square(np.arccos(np.minimum(cosines, 1.0)))
        variations[:, part] = np.add.reduceat(squares, first_members) / sizes
    return np.median(variations, axis=1)
