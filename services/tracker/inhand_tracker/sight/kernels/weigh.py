"""Weighing poses by what a frame shows: one pass over the points of each pose's view."""

from typing import NamedTuple

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Flags, Singles
from inhand_tracker.sight.kernels.inputs import Outlines, ScoredPixels, Sensor
from inhand_tracker.sight.kernels.projection import (
    NEAREST,
    depth_noise,
    edge_channel,
    image_normal,
    in_image,
    is_covered,
    projected,
    rotated,
    rotation_matrix,
    view_of_pose,
)

EDGES, REGION, INTERIOR, DEPTH, VISIBLE = range(5)
"""The columns of the scores; the last is no term."""
OUTLINE_PIXELS = (1.0, 2.5, 5.0)
"""Distances in pixels at which the outline's two sides are looked at, for an object of the usual
size: beside the edge's blur, and as far as most objects are thick."""
DEPTH_ROWS, DEPTH_ROWS_PER_M = 64, 8
DEPTH_COLUMNS, DEPTH_COLUMNS_PER_NOISE = 128, 8
"""Layout of the table of depth scores: distances to 8 m, errors to 8 deviations on either side."""


class WeighSettings(NamedTuple):
    """Which terms are ``wanted`` (4,), the table of ``depth_scores``, and numbers of
    ``SightParameters``; ``scale_per_pixel`` is one over the usual size in pixels."""

    wanted: Flags
    depth_scores: Singles
    sensor: Sensor
    limb_weight: np.float32
    scale_per_pixel: np.float32
    least_outline_scale: np.float32
    most_outline_scale: np.float32
    least_interior_scale: np.float32
    most_interior_scale: np.float32


@njit(cache=True, nogil=True, fastmath={"nsz", "arcp", "contract", "afn", "reassoc"})
def weigh(
    translations: Singles,
    rotations: Singles,
    outlines: Outlines,
    pixels: ScoredPixels,
    settings: WeighSettings,
    scores: Singles,
) -> None:
    """Fill ``scores`` (P, 5) of poses (P, 3) and (P, 4): the mean of each term over the points of
    a pose's view, of those at the outline times its length, and the share of points that lie in the
    image with nothing in front.

    What is not wanted is not read, and its scores are 0.
    """
    grid, directions, points, normals, inside, outside, surface_points, _, sizes, lengths = outlines
    lens, edges, edge_scores, colour_scores, limbs, depth, _ = pixels
    wanted, depth_scores, sensor = settings.wanted, settings.depth_scores, settings.sensor
    limb_weight, scale_per_pixel = settings.limb_weight, settings.scale_per_pixel
    least_outline, most_outline = settings.least_outline_scale, settings.most_outline_scale
    least_interior, most_interior = settings.least_interior_scale, settings.most_interior_scale
    height, width = limbs.shape
    zero, half, one = np.float32(0.0), np.float32(0.5), np.float32(1.0)
    corner_lens = lens[0], lens[1], lens[2] + half, lens[3] + half
    fx, fy, cx, cy = corner_lens
    wide, high = np.float32(width), np.float32(height)
    outline_count, surface_count = points.shape[2], surface_points.shape[2]
    most = max(outline_count, surface_count)
    u, v, away = np.empty(most, np.float32), np.empty(most, np.float32), np.empty(most, np.float32)
    nu, nv = np.empty(most, np.float32), np.empty(most, np.float32)
    surface_share = one / surface_count
    for pose in range(len(translations)):
        tx, ty, tz = translations[pose, 0], translations[pose, 1], translations[pose, 2]
        turn = rotation_matrix(
            rotations[pose, 0], rotations[pose, 1], rotations[pose, 2], rotations[pose, 3]
        )
        view = view_of_pose(grid, directions, turn, tx, ty, tz)
        edge_sum, region_sum, interior_sum, depth_sum = zero, zero, zero, zero
        asked, visible = zero, zero
        # Points are denser on a shorter outline, and each of them stands for less.
        outline_share = lengths[view] / outline_count
        size = sizes[view] * fx / max(tz, NEAREST)
        reach = min(max(size * scale_per_pixel, least_outline), most_outline)
        noise = depth_noise(sensor.noise_m, sensor.noise_per_m, max(tz, NEAREST))
        margin = sensor.covered_m + np.float32(2.0) * noise
        if wanted[EDGES] or wanted[REGION]:
            asked += outline_count
            for point in range(outline_count):
                a, b, c = points[view, 0, point], points[view, 1, point], points[view, 2, point]
                x, y, z = rotated(turn, a, b, c)
                pz = z + tz
                x, y = (x + tx) / pz, (y + ty) / pz
                away[point] = pz
                u[point], v[point] = fx * x + cx, fy * y + cy
                a, b, c = normals[view, 0, point], normals[view, 1, point], normals[view, 2, point]
                nx, ny = image_normal(corner_lens, rotated(turn, a, b, c), x, y, one)
                length = one / np.sqrt(nx * nx + ny * ny + np.float32(1e-9))
                nu[point], nv[point] = nx * length, ny * length
            for point in range(outline_count):
                pu, pv, pz = u[point], v[point], away[point]
                if not (pz > NEAREST and in_image(pu, pv, wide, high)):
                    continue
                column, row = int(pu), int(pv)
                if is_covered(depth[row, column], pz, margin):
                    continue
                visible += one
                nx, ny = nu[point], nv[point]
                if wanted[EDGES]:
                    channel = edge_channel(nx, ny)
                    score = edge_scores[channel, edges[channel, row, column]]
                    edge_sum += limb_weight * score if limbs[row, column] else score
                if wanted[REGION]:
                    within = inside[view, point] * fx / pz
                    beside = outside[view, point] * fx / pz
                    for offset in OUTLINE_PIXELS:
                        step = np.float32(offset) * reach
                        if step < within:
                            near_u, near_v = pu - step * nx, pv - step * ny
                            if in_image(near_u, near_v, wide, high):
                                region_sum += colour_scores[int(near_v), int(near_u), 0]
                        if step < beside:
                            far_u, far_v = pu + step * nx, pv + step * ny
                            if in_image(far_u, far_v, wide, high):
                                region_sum += colour_scores[int(far_v), int(far_u), 1]
        if wanted[INTERIOR] or wanted[DEPTH]:
            asked += surface_count
            for point in range(surface_count):
                a = surface_points[view, 0, point]
                b = surface_points[view, 1, point]
                c = surface_points[view, 2, point]
                x, y, z = rotated(turn, a, b, c)
                pz = z + tz
                away[point] = pz
                u[point], v[point] = projected(corner_lens, x + tx, y + ty, pz)
            depth_row = min(int(max(tz, zero) * DEPTH_ROWS_PER_M), DEPTH_ROWS - 1)
            columns_per_m = np.float32(DEPTH_COLUMNS_PER_NOISE) / noise
            for point in range(surface_count):
                pu, pv, pz = u[point], v[point], away[point]
                if not (pz > NEAREST and in_image(pu, pv, wide, high)):
                    continue
                column, row = int(pu), int(pv)
                measured = depth[row, column]
                error = measured - pz
                if wanted[DEPTH] and measured > zero:
                    place = error * columns_per_m + np.float32(DEPTH_COLUMNS // 2)
                    place = min(max(place, zero), np.float32(DEPTH_COLUMNS - 1))
                    depth_sum += depth_scores[depth_row, int(place)]
                if is_covered(measured, pz, margin):
                    continue
                visible += one
                if wanted[INTERIOR]:
                    interior_sum += colour_scores[row, column, 0] - colour_scores[row, column, 1]
        bulk = min(max(size * scale_per_pixel, least_interior), most_interior)
        scores[pose, EDGES] = edge_sum * outline_share
        scores[pose, REGION] = region_sum * outline_share
        scores[pose, INTERIOR] = interior_sum * surface_share * bulk
        scores[pose, DEPTH] = depth_sum * surface_share
        scores[pose, VISIBLE] = visible / max(asked, one)
