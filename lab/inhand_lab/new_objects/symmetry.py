"""Finds on a mesh itself which turns and which mirror planes leave it as it is.

A turn or reflection is tried on points of the surface: nearly all of them must come to lie on the
surface again. Every such turn goes through the surface's centroid; where a surface is drawn double,
as by a label on one side, it may go through the middle of the box around it instead.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.shape.shape import Symmetry

from inhand_lab.geometry.surface_distance import MeasuredSurface
from inhand_lab.geometry.transforms import rotation_from_vector
from inhand_lab.new_objects.parameters import DEFAULT_PROPOSAL, ProposalParameters

AXES = np.eye(3)


@dataclass(frozen=True)
class SelfComparison:
    """A mesh, vertices (V, 3) in metres and faces (F, 3), that is compared with its own image."""

    vertices: Array
    faces: Indices
    parameters: ProposalParameters = DEFAULT_PROPOSAL

    @cached_property
    def surface(self) -> MeasuredSurface:
        """The surface that distances are measured from."""
        chosen = self.parameters
        return MeasuredSurface(self.vertices, self.faces, chosen.samples, chosen.neighbours)

    @cached_property
    def tolerance_m(self) -> float:
        """Distance by which an image may miss the surface, metres."""
        middle = float(np.sort(np.ptp(self.vertices, axis=0))[1])
        return max(self.parameters.tolerance_m, self.parameters.tolerance_share * middle)

    @cached_property
    def centroid(self) -> Array:
        """The centroid (3,) of the surface."""
        corners, areas = self._triangles
        return areas @ corners.mean(axis=1) / areas.sum()

    @cached_property
    def directions(self) -> Array:
        """Unit directions (D, 3) of axes and mirror normals that are tried.

        They are the mesh's own axes, the surface's principal ones, and those that most of the
        surface faces.
        """
        corners, areas = self._triangles
        from_middle = corners - self.centroid
        sums = from_middle.sum(axis=1)
        moments = np.einsum("f,fki,fkj->ij", areas, from_middle, from_middle)
        moments += np.einsum("f,fi,fj->ij", areas, sums, sums)
        principal = np.linalg.eigh(moments)[1].T
        faced = _faced_directions(corners, self.parameters.normals)
        return _distinct(np.concatenate([AXES, principal, faced]), self.parameters.parallel)

    @cached_property
    def centres(self) -> Array:
        """Points (1 or 2, 3) through which axes and mirror planes are tried."""
        middle = (self.vertices.min(axis=0) + self.vertices.max(axis=0)) / 2.0
        apart = np.linalg.norm(middle - self.centroid) > self.parameters.same_centre_m
        return np.array([self.centroid, middle] if apart else [self.centroid])

    def miss(self, matrix: Array, centre: Array) -> float:
        """Distance in metres by which an image under a matrix (3, 3) misses the surface.

        The matrix turns or mirrors about a centre (3,); a small share of the points is left out.
        """
        chosen = self.parameters
        return self._miss(matrix, centre, chosen.compared, chosen.compared_share)

    def bears(self, matrix: Array, centre: Array) -> bool:
        """Whether the mesh looks the same under a matrix (3, 3) about a centre (3,)."""
        chosen = self.parameters
        screened = self._miss(matrix, centre, chosen.screened, chosen.screened_share)
        return screened <= self.tolerance_m and self.miss(matrix, centre) <= self.tolerance_m

    def _miss(self, matrix: Array, centre: Array, count: int, share: float) -> float:
        """Distance that a share of the images of ``count`` points is within, metres."""
        image = (self.surface.points(count) - centre) @ matrix.T + centre
        return float(np.quantile(self.surface.distances(image), share))

    @cached_property
    def _triangles(self) -> tuple[Array, Array]:
        """Corners (F, 3, 3) and areas (F,)."""
        corners = self.vertices[self.faces]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        return corners, np.linalg.norm(across, axis=1) / 2.0


def find_symmetries(compared: SelfComparison) -> tuple[Symmetry, ...]:
    """Find the axes about which turns leave a mesh as it is, those of the most turns first.

    Of a round thing two are enough: its axis, and one across it where both its ends are alike.
    """
    chosen = compared.parameters
    found = [one for axis in compared.directions if (one := _turns_about(compared, axis))]
    round_things = [one for one in found if one.order == 0]
    if round_things:
        axis = np.array(round_things[0].axis)
        across = [one for one in found if abs(np.dot(one.axis, axis)) < chosen.parallel]
        return (round_things[0], *across[:1])
    return tuple(sorted(found, key=lambda one: -one.order)[: chosen.most_axes])


def find_mirror(compared: SelfComparison) -> tuple[Array, Array] | None:
    """Find the normal (3,) of a mirror plane and a point (3,) of it; None where there is none."""
    for normal in compared.directions:
        for centre in compared.centres:
            if compared.bears(reflection(normal), centre):
                return normal, centre
    return None


def reflection(normal: Array) -> Array:
    """The matrix (3, 3) that mirrors in the plane of a unit normal (3,)."""
    return np.eye(3) - 2.0 * np.outer(normal, normal)


def _turns_about(compared: SelfComparison, axis: Array) -> Symmetry | None:
    """The turns about an axis that are borne, through one of the centres."""
    for centre in compared.centres:
        order = _order(compared, axis, centre)
        if order is not None:
            (x, y, z), middle = ((row.round(6) + 0.0).tolist() for row in (axis, centre))
            return Symmetry((x, y, z), (middle[0], middle[1], middle[2]), order)
    return None


def _order(compared: SelfComparison, axis: Array, centre: Array) -> int | None:
    """The number of equal turns about an axis that are borne; 0 for any, None for none."""

    def bears(angle: float) -> bool:
        return compared.bears(rotation_from_vector(angle * axis), centre)

    if all(bears(angle) for angle in compared.parameters.any_angle):
        return 0
    return next((n for n in compared.parameters.orders if bears(2.0 * np.pi / n)), None)


def _faced_directions(corners: Array, count: int) -> Array:
    """Unit directions (D ≤ count, 3) that most of the area of triangles (F, 3, 3) faces."""
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(across, axis=1)
    normals = across[areas > 0.0] / areas[areas > 0.0, None]
    rounded, owner = np.unique(normals.round(2), axis=0, return_inverse=True)
    faced = np.bincount(owner.ravel(), areas[areas > 0.0], len(rounded))
    sums = np.zeros_like(rounded)
    np.add.at(sums, owner.ravel(), across[areas > 0.0])
    largest = np.argsort(-faced, kind="stable")[:count]
    return sums[largest] / np.linalg.norm(sums[largest], axis=1, keepdims=True)


def _distinct(directions: Array, parallel: float) -> Array:
    """Directions (D, 3) without those that are parallel to an earlier one."""
    kept: list[Array] = []
    for direction in directions:
        if all(np.linalg.norm(np.cross(direction, other)) > parallel for other in kept):
            kept.append(direction)
    return np.array(kept)
