"""Distances of points from a triangle mesh, and of two meshes from each other."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import trimesh
from inhand_tracker.geometry.arrays import Array, Indices
from scipy.spatial import KDTree

SEED = 0
"""Seed of the draw of points on a surface: the same mesh gives the same points."""


@dataclass(frozen=True)
class MeasuredSurface:
    """A mesh, vertices (V, 3) and faces (F, 3), that distances are measured from.

    The nearest triangle is looked for among those of the ``neighbours`` nearest of ``samples``
    points on the surface, so that a distance may be too large by a share of their spacing where
    triangles are smaller than that.
    """

    vertices: Array
    faces: Indices
    samples: int
    neighbours: int

    def points(self, count: int) -> Array:
        """Draw points (count, 3), evenly spread on the surface."""
        return self._drawn[0][_evenly(self.samples, count)]

    def distances(self, points: Array) -> Array:
        """Measure the distances (N,) of points (N, 3) from the surface."""
        return np.linalg.norm(self.nearest(points) - points, axis=1)

    def nearest(self, points: Array) -> Array:
        """Find the nearest points (N, 3) of the surface to points (N, 3)."""
        _, near = self._tree.query(points, k=self.neighbours)
        candidates = self._drawn[1][near]
        corners = self.vertices[self.faces[candidates]].reshape(-1, 3, 3)
        repeated = np.repeat(points, self.neighbours, axis=0)
        on_surface = trimesh.triangles.closest_point(  # type: ignore[no-untyped-call]
            corners, repeated
        ).reshape(len(points), self.neighbours, 3)
        distances = np.linalg.norm(on_surface - points[:, None], axis=2)
        chosen: Array = on_surface[np.arange(len(points)), distances.argmin(axis=1)]
        return chosen

    @cached_property
    def _drawn(self) -> tuple[Array, Indices]:
        """Points (S, 3) in no order, and the face (S,) that each is of."""
        mesh = trimesh.Trimesh(self.vertices, self.faces, process=False)
        points, faces = trimesh.sample.sample_surface(mesh, self.samples, seed=SEED)[:2]
        return np.asarray(points, np.float64), np.asarray(faces, np.int64)

    @cached_property
    def _tree(self) -> KDTree:
        return KDTree(self._drawn[0])


def mean_surface_distance(first: MeasuredSurface, second: MeasuredSurface, count: int) -> float:
    """Mean distance in metres between two surfaces, by ``count`` points of each."""
    there = second.distances(first.points(count)).mean()
    back = first.distances(second.points(count)).mean()
    return float((there + back) / 2.0)


def _evenly(total: int, count: int) -> Indices:
    return np.linspace(0, total - 1, min(count, total)).astype(np.int64)
