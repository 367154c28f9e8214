"""Weighing poses by what a frame shows: one pass over the points of each pose's view."""

from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numba import njit
from numpy.typing import NDArray

from inhand_tracker.geometry.arrays import Bytes, Flags, Singles
from inhand_tracker.shape.view_grid import nearest_view

Real: TypeAlias = Any
"""float32 or float64, as the caller has it; or an array of it."""

EDGES, REGION, INTERIOR, DEPTH, SEEN = range(5)
"""The columns of what ``weigh`` gives; the last is no term."""

NEAREST_M = np.float32(0.05)
IN_FRONT_M = np.float32(0.02)
"""A point is covered where the depth measured there is nearer by this and the sensor's noise."""
OUTLINE_PIXELS = (1.0, 2.5, 5.0)
"""How far from the outline its two sides are looked at, for an object of 60 pixels."""
USUAL_PIXELS = 60.0

DEPTH_NOISE_M = np.float32(0.003)
DEPTH_NOISE_PER_M = np.float32(0.0025)
"""Of structured light, at 1 m, growing with the square of the distance."""
ANYWHERE_PER_M = 0.5
"""The density of what is measured where the object is not."""
MEASURED = 0.9
LEAST_BEHIND = 0.02
"""How much of the rest of the world is measured, and how seldom something is behind by error."""
DEPTH_ROWS, DEPTH_ROWS_PER_M = 64, 8
DEPTH_COLUMNS, DEPTH_COLUMNS_PER_NOISE = 128, 8
"""The table of ``depth_scores``."""


@njit(cache=True, nogil=True, inline="always")
def depth_noise(depth: Real) -> Real:
    """The standard deviation in metres of a measured depth."""
    return DEPTH_NOISE_M + DEPTH_NOISE_PER_M * depth * depth


def depth_scores(returned: float, behind: float) -> Singles:
    """(DEPTH_ROWS, DEPTH_COLUMNS): log how many times likelier a measured depth is for a surface
    of the object there, by how far away the surface is and how far behind it was measured.

    ``returned`` and ``behind`` are those of ``Appearance``. What is in front may hide the object
    as well as anything else, and says nothing.
    """
    noise = depth_noise((np.arange(DEPTH_ROWS)[:, None] + 0.5) / DEPTH_ROWS_PER_M)
    off = (np.arange(DEPTH_COLUMNS) - DEPTH_COLUMNS // 2) / DEPTH_COLUMNS_PER_NOISE
    near = np.exp(-0.5 * off**2) / (np.sqrt(2.0 * np.pi) * noise)
    other = np.where(off < 0.0, 1.0, max(behind / MEASURED, LEAST_BEHIND))
    return np.log(returned * near / ANYWHERE_PER_M + other).astype(np.float32)


@njit(cache=True, nogil=True, inline="always", fastmath=True)
def turned(w: Real, x: Real, y: Real, z: Real) -> tuple[Real, ...]:
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
def channel_of(x: Real, y: Real) -> int:
    """Which channel of edges runs across a normal (x, y) in the image."""
    ax, ay = abs(x), abs(y)
    if ay < np.float32(0.41421356) * ax:
        return 0
    if ax < np.float32(0.41421356) * ay:
        return 2
    return 1 if x * y > np.float32(0.0) else 3


class Outlines(NamedTuple):
    """``Contours`` for the kernels, the coordinate before the point: (V, 3, B).

    ``grid`` finds the nearest direction (``view_grid``); ``sizes`` (V,) is the square root of the
    areas.
    """

    grid: NDArray[np.int16]
    directions: Singles
    points: Singles
    normals: Singles
    inside: Singles
    outside: Singles
    surface_points: Singles
    surface_normals: Singles
    sizes: Singles


class Pixels(NamedTuple):
    """A frame for the kernels: ``lens`` (fx, fy, cx, cy), distances to ``edges`` (4, H, W) with
    ``edge_scores`` (4, 8), ``colour_scores`` (H, W, 2) of a pixel's being within or beside the
    object, ``limbs`` (H, W) and ``depth`` (H, W)."""

    lens: Singles
    edges: Bytes
    edge_scores: Singles
    colour_scores: Singles
    limbs: Bytes
    depth: Singles


@njit(cache=True, nogil=True, fastmath={"nsz", "arcp", "contract", "afn", "reassoc"})
def weigh(
    translations: Singles,
    rotations: Singles,
    outlines: Outlines,
    pixels: Pixels,
    limb_weight: Real,
    depth_scores: Singles,
    wanted: Flags,
    scores: Singles,
) -> None:
    """Fill ``scores`` (P, 5): the mean over a view's points of what each term says of a pose, and
    the share of points that lie in the image with nothing in front.

    Poses are (P, 3) and (P, 4). ``wanted`` (4,) tells which terms are; what is not wanted is not
    read.
    """
    grid, directions, points, normals, inside, outside, surface_points, _, sizes = outlines
    lens, edges, edge_scores, colour_scores, limbs, depth = pixels
    height, width = limbs.shape
    zero, half, one = np.float32(0.0), np.float32(0.5), np.float32(1.0)
    fx, fy, cx, cy = lens[0], lens[1], lens[2] + half, lens[3] + half
    wide, high = np.float32(width), np.float32(height)
    outline_count, surface_count = points.shape[2], surface_points.shape[2]
    most = max(outline_count, surface_count)
    u, v, away = np.empty(most, np.float32), np.empty(most, np.float32), np.empty(most, np.float32)
    nu, nv = np.empty(most, np.float32), np.empty(most, np.float32)
    outline_share, surface_share = one / outline_count, one / surface_count
    for pose in range(len(translations)):
        tx, ty, tz = translations[pose, 0], translations[pose, 1], translations[pose, 2]
        r0, r1, r2, r3, r4, r5, r6, r7, r8 = turned(
            rotations[pose, 0], rotations[pose, 1], rotations[pose, 2], rotations[pose, 3]
        )
        view = nearest_view(
            grid,
            directions,
            -(r0 * tx + r3 * ty + r6 * tz),
            -(r1 * tx + r4 * ty + r7 * tz),
            -(r2 * tx + r5 * ty + r8 * tz),
        )
        edge_sum, region_sum, interior_sum, depth_sum = zero, zero, zero, zero
        asked, seen = zero, zero
        size = sizes[view] * fx / max(tz, NEAREST_M)
        reach = min(max(size / np.float32(USUAL_PIXELS), np.float32(0.6)), np.float32(2.5))
        noise = depth_noise(max(tz, NEAREST_M))
        in_front = IN_FRONT_M + np.float32(2.0) * noise
        if wanted[EDGES] or wanted[REGION]:
            asked += outline_count
            for point in range(outline_count):
                a, b, c = points[view, 0, point], points[view, 1, point], points[view, 2, point]
                pz = r6 * a + r7 * b + r8 * c + tz
                x = (r0 * a + r1 * b + r2 * c + tx) / pz
                y = (r3 * a + r4 * b + r5 * c + ty) / pz
                away[point] = pz
                u[point] = fx * x + cx
                v[point] = fy * y + cy
                a, b, c = normals[view, 0, point], normals[view, 1, point], normals[view, 2, point]
                nz = r6 * a + r7 * b + r8 * c
                nx = fx * (r0 * a + r1 * b + r2 * c - nz * x)
                ny = fy * (r3 * a + r4 * b + r5 * c - nz * y)
                length = one / np.sqrt(nx * nx + ny * ny + np.float32(1e-9))
                nu[point] = nx * length
                nv[point] = ny * length
            for point in range(outline_count):
                pu, pv = u[point], v[point]
                pz = away[point]
                if not (pz > NEAREST_M and pu >= zero and pv >= zero and pu < wide and pv < high):
                    continue
                column, row = int(pu), int(pv)
                measured = depth[row, column]
                if measured > zero and measured < pz - in_front:
                    continue
                seen += one
                nx, ny = nu[point], nv[point]
                if wanted[EDGES]:
                    channel = channel_of(nx, ny)
                    said = edge_scores[channel, edges[channel, row, column]]
                    edge_sum += limb_weight * said if limbs[row, column] else said
                if wanted[REGION]:
                    within = inside[view, point] * fx / pz
                    beside = outside[view, point] * fx / pz
                    for offset in OUTLINE_PIXELS:
                        step = np.float32(offset) * reach
                        if step < within:
                            near_u, near_v = pu - step * nx, pv - step * ny
                            if zero <= near_u < wide and zero <= near_v < high:
                                region_sum += colour_scores[int(near_v), int(near_u), 0]
                        if step < beside:
                            far_u, far_v = pu + step * nx, pv + step * ny
                            if zero <= far_u < wide and zero <= far_v < high:
                                region_sum += colour_scores[int(far_v), int(far_u), 1]
        if wanted[INTERIOR] or wanted[DEPTH]:
            asked += surface_count
            for point in range(surface_count):
                a = surface_points[view, 0, point]
                b = surface_points[view, 1, point]
                c = surface_points[view, 2, point]
                pz = r6 * a + r7 * b + r8 * c + tz
                away[point] = pz
                u[point] = fx * (r0 * a + r1 * b + r2 * c + tx) / pz + cx
                v[point] = fy * (r3 * a + r4 * b + r5 * c + ty) / pz + cy
            depth_row = min(int(max(tz, zero) * DEPTH_ROWS_PER_M), DEPTH_ROWS - 1)
            columns_per_m = np.float32(DEPTH_COLUMNS_PER_NOISE) / noise
            for point in range(surface_count):
                pu, pv = u[point], v[point]
                pz = away[point]
                if not (pz > NEAREST_M and pu >= zero and pv >= zero and pu < wide and pv < high):
                    continue
                column, row = int(pu), int(pv)
                measured = depth[row, column]
                error = measured - pz
                if wanted[DEPTH] and measured > zero:
                    place = error * columns_per_m + np.float32(DEPTH_COLUMNS // 2)
                    place = min(max(place, zero), np.float32(DEPTH_COLUMNS - 1))
                    depth_sum += depth_scores[depth_row, int(place)]
                if measured > zero and error < -in_front:
                    continue
                seen += one
                if wanted[INTERIOR]:
                    interior_sum += colour_scores[row, column, 0] - colour_scores[row, column, 1]
        bulk = min(max(size / np.float32(USUAL_PIXELS), np.float32(0.3)), np.float32(3.0))
        scores[pose, EDGES] = edge_sum * outline_share
        scores[pose, REGION] = region_sum * outline_share
        scores[pose, INTERIOR] = interior_sum * surface_share * bulk
        scores[pose, DEPTH] = depth_sum * surface_share
        scores[pose, SEEN] = seen / max(asked, one)
