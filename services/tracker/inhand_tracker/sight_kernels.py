"""Weighing poses by what a frame shows: one pass over the points of each pose's view."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from inhand_tracker.view_grid import nearest_view

Floats = NDArray[np.float32]
Bytes = NDArray[np.uint8]

EDGES, REGION, INTERIOR, DEPTH = range(4)
"""The columns of what ``weigh`` gives."""

NEAREST_M = np.float32(0.05)
IN_FRONT_M = np.float32(0.02)
"""A point is covered where the depth measured there is nearer by this and the sensor's noise."""
OUTLINE_PIXELS = (1.0, 2.5, 5.0)
"""How far from the outline its two sides are looked at, for an object of 60 pixels."""
USUAL_PIXELS = 60.0

DEPTH_NOISE_M = np.float32(0.006)
DEPTH_NOISE_PER_M = np.float32(0.0025)
"""Of structured light, at 1 m, growing with the square of the distance."""
OCCLUDED = np.float32(0.25)
OUTLIER = np.float32(0.01)
ANYWHERE_PER_M = np.float32(0.5)
"""Densities of a measurement of the object: the prior share of what is in front, of what is
behind all the same, and of what is measured where the object is not."""


@njit(cache=True, nogil=True, inline="always")
def depth_noise(depth: float) -> float:
    """The standard deviation in metres of a measured depth."""
    return DEPTH_NOISE_M + DEPTH_NOISE_PER_M * depth * depth


@njit(cache=True, nogil=True, inline="always")
def depth_ratio(error: float, noise: float, returned: float) -> float:
    """How many times likelier a measurement ``error`` behind the surface is for the object's
    being there; ``returned`` is how much of its surface gives back depth."""
    near = np.exp(np.float32(-0.5) * error * error / (noise * noise)) / (np.float32(2.5066) * noise)
    seen = (np.float32(1.0) - OCCLUDED - OUTLIER) * near / ANYWHERE_PER_M + OUTLIER
    if error < np.float32(0.0):
        seen += OCCLUDED
    return returned * seen + np.float32(1.0) - returned


@njit(cache=True, nogil=True, inline="always", fastmath=True)
def turned(w: float, x: float, y: float, z: float) -> tuple[float, ...]:
    """The rotation matrix, row by row, of a unit quaternion."""
    one, two = np.float32(1.0), np.float32(2.0)
    return (
        one - two * (y * y + z * z),
        two * (x * y - w * z),
        two * (x * z + w * y),
        two * (x * y + w * z),
        one - two * (x * x + z * z),
        two * (y * z - w * x),
        two * (x * z - w * y),
        two * (y * z + w * x),
        one - two * (x * x + y * y),
    )


@njit(cache=True, nogil=True, inline="always", fastmath=True)
def channel_of(x: float, y: float) -> int:
    """Which channel of edges runs across a normal (x, y) in the image."""
    ax, ay = abs(x), abs(y)
    if ay < np.float32(0.41421356) * ax:
        return 0
    if ax < np.float32(0.41421356) * ay:
        return 2
    return 1 if x * y > np.float32(0.0) else 3


@njit(cache=True, nogil=True, fastmath=True)
def weigh(
    translations: Floats,
    rotations: Floats,
    grid: NDArray[np.int16],
    directions: Floats,
    points: Floats,
    normals: Floats,
    inside: Floats,
    outside: Floats,
    surface_points: Floats,
    areas: Floats,
    lens: Floats,
    edges: Bytes,
    edge_scores: Floats,
    colour_scores: Floats,
    limbs: Bytes,
    depth: Floats,
    returned: float,
    limb_weight: float,
    wanted: NDArray[np.bool_],
    scores: Floats,
) -> None:
    """Fill ``scores`` (P, 4): the mean over a view's points of what each term says of a pose.

    The model's arrays are those of ``Contours``; ``lens`` is (fx, fy, cx, cy); ``edges``
    (4, H, W) with ``edge_scores`` (4, 256), ``colour_scores`` (H, W, 2) of a pixel's being within
    or beside the object, ``limbs`` (H, W) and ``depth`` (H, W). ``wanted`` (4,) tells which terms
    are; what is not wanted is not read.
    """
    height, width = limbs.shape
    fx, fy, cx, cy = lens
    half = np.float32(0.5)
    outline_count, surface_count = points.shape[1], surface_points.shape[1]
    for pose in range(len(translations)):
        tx, ty, tz = translations[pose]
        w, x, y, z = rotations[pose]
        r0, r1, r2, r3, r4, r5, r6, r7, r8 = turned(w, x, y, z)
        view = nearest_view(
            grid,
            directions,
            -(r0 * tx + r3 * ty + r6 * tz),
            -(r1 * tx + r4 * ty + r7 * tz),
            -(r2 * tx + r5 * ty + r8 * tz),
        )
        edge_sum = region_sum = interior_sum = depth_sum = np.float32(0.0)
        size = np.float32(0.0)
        if tz > NEAREST_M:
            size = np.sqrt(areas[view]) * fx / tz
        reach = min(max(size / np.float32(USUAL_PIXELS), np.float32(0.6)), np.float32(2.5))
        if wanted[EDGES] or wanted[REGION]:
            for point in range(outline_count):
                a, b, c = points[view, point]
                pz = r6 * a + r7 * b + r8 * c + tz
                if pz < NEAREST_M:
                    continue
                px = r0 * a + r1 * b + r2 * c + tx
                py = r3 * a + r4 * b + r5 * c + ty
                inverse = np.float32(1.0) / pz
                u = fx * px * inverse + cx
                v = fy * py * inverse + cy
                if not (u > -half and v > -half and u < width - half and v < height - half):
                    continue
                column, row = int(u + half), int(v + half)
                measured = depth[row, column]
                nearest = pz - IN_FRONT_M - np.float32(2.0) * depth_noise(pz)
                if measured > np.float32(0.0) and measured < nearest:
                    continue
                a, b, c = normals[view, point]
                nz = (r6 * a + r7 * b + r8 * c) * inverse
                nx = fx * (r0 * a + r1 * b + r2 * c - nz * px)
                ny = fy * (r3 * a + r4 * b + r5 * c - nz * py)
                if wanted[EDGES]:
                    channel = channel_of(nx, ny)
                    said = edge_scores[channel, edges[channel, row, column]]
                    edge_sum += limb_weight * said if limbs[row, column] else said
                if wanted[REGION]:
                    length = np.float32(1.0) / np.sqrt(nx * nx + ny * ny + np.float32(1e-12))
                    nx *= length
                    ny *= length
                    within = inside[view, point] * fx * inverse
                    beside = outside[view, point] * fx * inverse
                    for away in OUTLINE_PIXELS:
                        step = np.float32(away) * reach
                        if step < within:
                            near_u, near_v = u - step * nx, v - step * ny
                            if near_u > 0.0 and near_v > 0.0:
                                column, row = int(near_u + half), int(near_v + half)
                                if column < width and row < height:
                                    region_sum += colour_scores[row, column, 0]
                        if step < beside:
                            far_u, far_v = u + step * nx, v + step * ny
                            if far_u > 0.0 and far_v > 0.0:
                                column, row = int(far_u + half), int(far_v + half)
                                if column < width and row < height:
                                    region_sum += colour_scores[row, column, 1]
        if wanted[INTERIOR] or wanted[DEPTH]:
            for point in range(surface_count):
                a, b, c = surface_points[view, point]
                pz = r6 * a + r7 * b + r8 * c + tz
                if pz < NEAREST_M:
                    continue
                inverse = np.float32(1.0) / pz
                u = fx * (r0 * a + r1 * b + r2 * c + tx) * inverse + cx
                v = fy * (r3 * a + r4 * b + r5 * c + ty) * inverse + cy
                if not (u > -half and v > -half and u < width - half and v < height - half):
                    continue
                column, row = int(u + half), int(v + half)
                error = depth[row, column] - pz
                noise = depth_noise(pz)
                measured = depth[row, column] > np.float32(0.0)
                if wanted[DEPTH] and measured:
                    depth_sum += np.log(depth_ratio(error, noise, returned))
                covered = measured and error < -IN_FRONT_M - np.float32(2.0) * noise
                if wanted[INTERIOR] and not covered:
                    interior_sum += colour_scores[row, column, 0]
                    interior_sum -= colour_scores[row, column, 1]
        scores[pose, EDGES] = edge_sum / outline_count
        scores[pose, REGION] = region_sum / outline_count
        scores[pose, INTERIOR] = (
            interior_sum
            / surface_count
            * min(max(size / np.float32(USUAL_PIXELS), np.float32(0.3)), np.float32(3.0))
        )
        scores[pose, DEPTH] = depth_sum / surface_count
