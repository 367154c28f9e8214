"""Finds the table in a depth image, and cuts out the one thing that stands on it.

The camera is held about upright and looks down at the table, which is the largest plane before it.
"""

from dataclasses import dataclass

import numpy as np
from inhand_runtime.errors import InhandError
from inhand_runtime.wording import counted
from inhand_tracker.geometry.arrays import Array, Flags, Indices
from inhand_tracker.geometry.camera import Intrinsics
from scipy import ndimage
from scipy.spatial import ConvexHull, KDTree

from inhand_lab.geometry.transforms import Transform, normalised
from inhand_lab.new_objects.parameters import DEFAULT_MEASURING, MeasuringParameters

UP_IN_CAMERA = np.array([0.0, -1.0, 0.0])
NEIGHBOURS = np.ones((3, 3), bool)


class MeasuringError(InhandError):
    """A thing cannot be measured by the camera; the message says the mend."""


@dataclass(frozen=True)
class Standing:
    """A thing on a table, and the depth image in which it is seen.

    ``points`` (N, 3) of its surface are in the table's frame, metres: the table is the plane z = 0
    with z up. They are those of the pixels ``seen`` (H, W), and are higher than ``cut_m``, up to
    where depth does not tell the thing from the table; ``measured`` (H, W) are the pixels that
    have any depth. ``distance_m`` is the thing's from the camera.
    """

    points: Array
    seen: Flags
    measured: Flags
    cut_m: float
    camera_from_table: Transform
    intrinsics: Intrinsics

    @property
    def distance_m(self) -> float:
        """Median distance of the points from the camera, along its axis."""
        return float(np.median(self.camera_from_table.apply(self.points)[:, 2]))


def cut_out(
    depth: Array, intrinsics: Intrinsics, parameters: MeasuringParameters = DEFAULT_MEASURING
) -> Standing:
    """Cut out what stands on the table in depth (H, W), metres, 0 where nothing was measured.

    Raises MeasuringError where there is no table, nothing or more than one thing on it, or the
    thing is cut off by the edge of the image.
    """
    near = (depth > 0.0) & (depth < parameters.farthest_m)
    rows, columns = np.nonzero(near)
    pixels = np.column_stack((columns, rows)).astype(np.float64)
    points = intrinsics.unproject(pixels, depth[near].astype(np.float64))
    camera_from_table = _find_table(points, parameters)
    on_table = camera_from_table.inverse().apply(points)
    tolerance = _tolerance(points, parameters)
    is_table = np.abs(on_table[:, 2]) < tolerance
    patch = on_table[_largest_patch(is_table, rows, columns, depth.shape)]
    least = parameters.least_height_m + tolerance
    high = np.flatnonzero((on_table[:, 2] > least) & (on_table[:, 2] < parameters.most_height_m))
    above = high[_within(on_table[high], patch)]
    thing = above[_only_thing(on_table[above], parameters)]
    _require_inside(rows[thing], columns[thing], depth.shape, parameters)
    seen = np.zeros(depth.shape, bool)
    seen[rows[thing], columns[thing]] = True
    cut_m = float(np.median(least[thing]))
    return Standing(on_table[thing], seen, depth > 0.0, cut_m, camera_from_table, intrinsics)


def _find_table(points: Array, parameters: MeasuringParameters) -> Transform:
    """The table's frame of the largest plane in points (N, 3) that faces up."""
    if len(points) < parameters.fewest_points:
        raise MeasuringError(
            f"depth shows {counted(len(points), 'point')} within {parameters.farthest_m:g} m: put "
            "the camera half a metre to a metre and a half from the table"
        )
    random = np.random.default_rng(parameters.seed)
    tried = points[random.integers(len(points), size=parameters.tried_points)]
    corners = tried[random.integers(len(tried), size=(parameters.tried_planes, 3))]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    kept = lengths > 0.0
    normals = normals[kept] / lengths[kept, None]
    normals *= np.sign(normals @ UP_IN_CAMERA)[:, None]
    kept_corners = corners[kept, 0]
    facing = (normals @ UP_IN_CAMERA > parameters.least_rise) & (
        np.einsum("pi,pi->p", normals, kept_corners) < 0.0
    )
    if not facing.any():
        raise MeasuringError(_NO_TABLE)
    offsets = np.einsum("pi,pi->p", normals[facing], kept_corners[facing])
    distances = np.abs(tried @ normals[facing].T - offsets)
    counts = (distances < _tolerance(tried, parameters)[:, None]).sum(axis=0)
    best = int(counts.argmax())
    if counts[best] < parameters.least_plane_share * len(tried):
        raise MeasuringError(_NO_TABLE)
    return _refined(points, normals[facing][best], float(offsets[best]), parameters)


_NO_TABLE = (
    "no table is seen: hold the camera upright, half a metre to a metre and a half from the table, "
    "so that it looks down and the table fills most of the image"
)


def _refined(
    points: Array, normal: Array, offset: float, parameters: MeasuringParameters
) -> Transform:
    """The table's frame of the plane through the points that are nearest to a plane."""
    for _ in range(3):
        inliers = points[np.abs(points @ normal - offset) < _tolerance(points, parameters)]
        middle = inliers.mean(axis=0)
        spread = (inliers - middle).T @ (inliers - middle)
        flattest = np.linalg.eigh(spread)[1][:, 0]
        normal = flattest * np.sign(flattest @ normal)
        offset = float(middle @ normal)
    right = normalised(np.cross(normal, [0.0, 0.0, -1.0]))
    return Transform(middle, np.column_stack((right, np.cross(normal, right), normal)))


def _tolerance(points: Array, parameters: MeasuringParameters) -> Array:
    """Distances (N,) by which depth may err at points (N, 3) in the camera's frame."""
    return parameters.plane_m + parameters.plane_m_per_m2 * points[:, 2] ** 2


def _largest_patch(chosen: Flags, rows: Indices, columns: Indices, shape: tuple[int, ...]) -> Flags:
    """Which of the points (N,) that are chosen hang together in the image, most of them."""
    image = np.zeros(shape, bool)
    image[rows[chosen], columns[chosen]] = True
    labels, _ = ndimage.label(ndimage.binary_opening(image, NEIGHBOURS), NEIGHBOURS)
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    if not sizes.any():
        raise MeasuringError(_NO_TABLE)
    return np.asarray(chosen & (labels[rows, columns] == sizes.argmax()))


def _within(points: Array, patch: Array) -> Flags:
    """Which points (N, 3) in the table's frame are above points (P, 3) of the table."""
    edges = ConvexHull(patch[:, :2]).equations
    return np.asarray((points[:, :2] @ edges[:, :2].T + edges[:, 2] < 0.0).all(axis=1))


def _only_thing(points: Array, parameters: MeasuringParameters) -> Indices:
    """The indices of the points (N, 3) above a table that are of the only thing on it.

    What is near to a much larger part belongs to it: a handle behind a cup.
    """
    if len(points) < parameters.fewest_points:
        raise MeasuringError("nothing stands on the table: put one thing on it, upright")
    cells = np.floor(points[:, :2] / parameters.cell_m).astype(np.int64)
    cells -= cells.min(axis=0)
    counts = np.zeros(cells.max(axis=0) + 1, np.int64)
    np.add.at(counts, tuple(cells.T), 1)
    labels, _ = ndimage.label(counts >= parameters.cell_points, NEIGHBOURS)
    owner = labels[tuple(cells.T)]
    sizes = np.bincount(owner)
    sizes[0] = 0
    largest = int(sizes.argmax())
    if sizes[largest] < parameters.fewest_points:
        raise MeasuringError("nothing stands on the table: put one thing on it, upright")
    tree = KDTree(points[owner == largest])
    parts = [largest]
    for other in np.flatnonzero(sizes >= parameters.fewest_part_points):
        gap = float(np.min(tree.query(points[owner == other])[0]))
        small = sizes[other] < parameters.most_part_share * sizes[largest]
        if other == largest or (small and gap < parameters.part_gap_m):
            parts.append(int(other))
        elif sizes[other] >= parameters.fewest_points:
            raise MeasuringError(
                f"two things stand on the table, {100.0 * gap:.0f} cm apart: leave one there, and "
                "keep hands out of view"
            )
    return np.flatnonzero(np.isin(owner, parts))


def _require_inside(
    rows: Indices, columns: Indices, shape: tuple[int, ...], parameters: MeasuringParameters
) -> None:
    border = parameters.border_pixels
    ends = (rows.min(), shape[0] - 1 - rows.max(), columns.min(), shape[1] - 1 - columns.max())
    if min(ends) < border:
        raise MeasuringError(
            "the thing is cut off by the edge of the image: turn the camera to it, or step back"
        )
