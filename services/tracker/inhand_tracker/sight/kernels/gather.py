"""Adding up what a frame says for moving poses: information and gradients of Gauss-Newton steps.

As contour trackers do (Stoiber et al. 2022): across each point of the outline, how likely it is
that the outline lies at each distance, by the colours on both sides and the edges between; and
the distances of the surface from the measured depth along its normals.
"""

from typing import NamedTuple

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array, Flags, Singles
from inhand_tracker.sight.kernels import projection
from inhand_tracker.sight.kernels.equations import (
    FAST,
    Equations,
    add,
    add_common,
    exponential,
    row_of,
    take_common,
)
from inhand_tracker.sight.kernels.inputs import Outlines, ScoredPixels, Sensor
from inhand_tracker.sight.kernels.mixed_offset import Mixing, mixed_offset
from inhand_tracker.sight.kernels.projection import Matrix


class GatherSettings(NamedTuple):
    """Which of edges, colours and depth are ``wanted`` (3,), which share of the surface returns
    depth, how much a point of the outline and of the surface counts, numbers of
    ``SightParameters``, and whether the outline is looked for by how colours mix across it."""

    wanted: Flags
    returned: float
    outline_weight: float
    surface_weight: float
    sensor: Sensor
    samples: int
    least_step_pixels: float
    widest_edge_step: float
    contour_error_m: float
    in_front_per_m: float
    behind_per_m: float
    colour_weight: float
    limb_factor: float
    common_pixels: float
    mixing: Mixing
    mixes: bool


@njit(cache=True, nogil=True, fastmath=FAST)
def gather(
    translations: Array,
    orientations: Array,
    reaches: Array,
    outlines: Outlines,
    pixels: ScoredPixels,
    settings: GatherSettings,
    equations: Equations,
) -> None:
    """Add to the ``equations`` of poses (K, 3) and (K, 4) what a frame says of each, which may be
    off by its one of ``reaches`` (K, 2), in metres and radians."""
    information, gradients = equations
    count = 2 * settings.samples + 1
    log_posterior, within, beside = np.empty(count), np.empty(count), np.empty(count)
    for pose in range(len(translations)):
        place = translations[pose, 0], translations[pose, 1], translations[pose, 2]
        reach = reaches[pose, 0], reaches[pose, 1]
        w, x, y, z = orientations[pose]
        turn = projection.rotation_matrix(w, x, y, z)
        view = projection.view_of_pose(
            outlines.grid, outlines.directions, turn, place[0], place[1], place[2]
        )
        if settings.wanted[0] or settings.wanted[1]:
            _gather_outline(
                (turn, place, view),
                reach,
                outlines,
                pixels,
                settings,
                (log_posterior, within, beside),
                (information[pose], gradients[pose]),
            )
        if settings.wanted[2]:
            _gather_surface(
                (turn, place, view),
                reach,
                outlines,
                pixels,
                settings,
                (information[pose], gradients[pose]),
            )


@njit(cache=True, nogil=True, fastmath=FAST)
def _gather_outline(
    seen: tuple[Matrix, tuple[float, float, float], int],
    most: tuple[float, float],
    outlines: Outlines,
    pixels: ScoredPixels,
    settings: GatherSettings,
    buffers: tuple[Array, Array, Array],
    equation: tuple[Array, Array],
) -> None:
    """Add what lies across each point of the outline to a pose's equation."""
    turn, place, view = seen
    lens = _corner_lens(pixels.lens)
    fx, fy = lens[0], lens[1]
    height, width = pixels.limbs.shape
    weight = settings.outline_weight * outlines.lengths[view]
    common = np.zeros(8)
    for point in range(outlines.points.shape[2]):
        a, b, c = outlines.points[view, :, point]
        arm, (px, py, pz), (u, v) = _placed(turn, place, (a, b, c), lens)
        if not projection.in_image(u, v, width, height):
            continue
        reach = _reach(arm, most)
        margin = settings.sensor.covered_m + 2.0 * _noise(pz, settings.sensor) + reach
        if projection.is_covered(pixels.depth[int(v), int(u)], pz, margin):
            continue
        a, b, c = outlines.normals[view, :, point]
        nx, ny = projection.image_normal(lens, projection.rotated(turn, a, b, c), px, py, pz)
        length = np.sqrt(nx * nx + ny * ny)
        if length < 1e-9:
            continue
        nx, ny = nx / length, ny / length
        sides = outlines.inside[view, point] * fx / pz, outlines.outside[view, point] * fx / pz
        line, contour_error = (u, v, nx, ny), np.square(settings.contour_error_m * fx / pz)
        if settings.mixes and min(sides) > settings.mixing.least_pixels:
            mean, variance = mixed_offset(line, sides, pixels, settings.mixing)
            certainty = settings.mixing.gain / (variance + contour_error)
        else:
            step = max(reach * fx / pz / settings.samples, settings.least_step_pixels)
            _sample_across(line, step, sides[1], pixels, settings, buffers)
            mean, variance = _outline_offset(step, settings.samples, sides[0], buffers)
            flat = settings.samples * (settings.samples + 1) * step * step / 3.0
            certainty = 1.0 / (variance + contour_error) - 1.0 / flat
        if certainty <= 0.0:
            continue
        # The pixel's displacement along (nx, ny) by a displacement of the point.
        across = nx * fx / pz, ny * fy / pz, -(nx * fx * px + ny * fy * py) / (pz * pz)
        row = row_of(across, arm)
        add(equation, row, mean, weight * certainty)
        add_common(common, row, mean, weight * certainty)
    # Blur and shade move all of an outline in or out.
    take_common(equation, common, settings.common_pixels)


@njit(cache=True, nogil=True, fastmath=FAST)
def _sample_across(
    line: tuple[float, float, float, float],
    step: float,
    gap: float,
    pixels: ScoredPixels,
    settings: GatherSettings,
    buffers: tuple[Array, Array, Array],
) -> None:
    """Fill the ``buffers`` with each sample's edge score, and its colour's scores within and
    beside the object, from inside out across the ``line`` (u, v, and its normal).

    Outwards colours count within the ``gap``, in pixels, where the silhouette begins anew.
    """
    u, v, nx, ny = line
    log_posterior, within, beside = buffers
    height, width = pixels.limbs.shape
    channel = projection.edge_channel(nx, ny)
    for sample in range(2 * settings.samples + 1):
        away = (sample - settings.samples) * step
        within[sample] = beside[sample] = log_posterior[sample] = 0.0
        su, sv = u + away * nx, v + away * ny
        if not projection.in_image(su, sv, width, height):
            continue
        column, row = int(su), int(sv)
        if settings.wanted[1] and away < gap:
            within[sample] = step * pixels.colour_scores[row, column, 0]
            beside[sample] = step * pixels.colour_scores[row, column, 1]
        if (
            settings.wanted[0]
            and step < settings.widest_edge_step
            and not pixels.limbs[row, column]
        ):
            distance = pixels.edges[channel, row, column]
            log_posterior[sample] = pixels.edge_scores[channel, distance]


@njit(cache=True, nogil=True, fastmath=FAST)
def _outline_offset(
    step: float, samples: int, thickness: float, buffers: tuple[Array, Array, Array]
) -> tuple[float, float]:
    """Return the mean and variance, in pixels, of where the outline lies across a point of it,
    where the silhouette is so many pixels thick.

    The ``buffers`` of ``_sample_across`` are used up.
    """
    log_posterior, within, beside = buffers
    count = 2 * samples + 1
    before = 0.0
    for sample in range(count):
        # Half of the pixel that the outline runs through is on either side.
        middle = 0.5 * (within[sample] - beside[sample])
        within[sample] = before + middle
        before += 2.0 * middle
    most = -1e30
    for sample in range(count):
        # The object lies between this outline and the one on its other side.
        other = sample - thickness / step
        score = within[sample]
        if other > 0.0:
            index = min(int(other), count - 2)
            part = other - index
            score -= (1.0 - part) * within[index] + part * within[index + 1]
        log_posterior[sample] += score
        most = max(most, log_posterior[sample])
    mass = mean = square = 0.0
    for sample in range(count):
        away = (sample - samples) * step
        share = exponential(log_posterior[sample] - most)
        mass += share
        mean += share * away
        square += share * away * away
    mean /= mass
    return mean, square / mass - mean * mean + 0.5 * step * step + 0.25


@njit(cache=True, nogil=True, fastmath=FAST)
def _gather_surface(
    seen: tuple[Matrix, tuple[float, float, float], int],
    most: tuple[float, float],
    outlines: Outlines,
    pixels: ScoredPixels,
    settings: GatherSettings,
    equation: tuple[Array, Array],
) -> None:
    """Add the measured depths at each point of the surface to a pose's equation."""
    turn, place, view = seen
    lens = _corner_lens(pixels.lens)
    height, width = pixels.limbs.shape
    for point in range(outlines.surface_points.shape[2]):
        a, b, c = outlines.surface_points[view, :, point]
        arm, (px, py, pz), (u, v) = _placed(turn, place, (a, b, c), lens)
        if not projection.in_image(u, v, width, height):
            continue
        reach = _reach(arm, most)
        column, row = int(u), int(v)
        measured = pixels.depth[row, column]
        if measured <= 0.0:
            continue
        error = measured - pz
        noise = _noise(pz, settings.sensor)
        deviation = np.sqrt(noise * noise + reach * reach / 3.0)
        near = exponential(-0.5 * error * error / (deviation * deviation)) / (2.5066 * deviation)
        density = settings.in_front_per_m if error < 0.0 else settings.behind_per_m
        other = density / max(settings.returned, 0.01)
        if settings.wanted[1]:
            # A colour of the surroundings shows that the surface is another thing's.
            scores = pixels.colour_scores[row, column]
            other *= np.exp(settings.colour_weight * (scores[1] - scores[0]))
        if pixels.limbs[row, column]:
            other *= settings.limb_factor
        a, b, c = outlines.surface_normals[view, :, point]
        across = projection.rotated(turn, a, b, c)
        # The measured point lies on the same ray, ``measured`` away.
        share = measured / pz - 1.0
        residual = share * (across[0] * px + across[1] * py + across[2] * pz)
        spread = deviation * max(abs(across[2]), 0.2)
        certainty = near / (near + other) / (spread * spread)
        add(equation, row_of(across, arm), residual, settings.surface_weight * certainty)


@njit(cache=True, nogil=True, inline="always", fastmath=FAST)
def _corner_lens(lens: Singles) -> tuple[float, float, float, float]:
    """Count pixels from the image's corner, as ``projection`` does."""
    return lens[0], lens[1], lens[2] + 0.5, lens[3] + 0.5


@njit(cache=True, nogil=True, inline="always", fastmath=FAST)
def _placed(
    turn: Matrix,
    place: tuple[float, float, float],
    point: tuple[float, float, float],
    lens: tuple[float, float, float, float],
) -> tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float]]:
    """Return a point of the object from the object's origin, from the camera, and its pixel, which
    is out of the image where the point is too near."""
    arm = projection.rotated(turn, point[0], point[1], point[2])
    x, y, z = arm[0] + place[0], arm[1] + place[1], arm[2] + place[2]
    u, v = -1.0, -1.0
    if z >= projection.NEAREST:
        u, v = projection.projected(lens, x, y, z)
    return arm, (x, y, z), (u, v)


@njit(cache=True, nogil=True, inline="always", fastmath=FAST)
def _reach(arm: tuple[float, float, float], most: tuple[float, float]) -> float:
    """Return how far a point may be off, in metres, at ``arm`` from the object's origin."""
    length = np.sqrt(arm[0] * arm[0] + arm[1] * arm[1] + arm[2] * arm[2])
    return most[0] + most[1] * length


@njit(cache=True, nogil=True, inline="always", fastmath=FAST)
def _noise(depth: float, sensor: Sensor) -> float:
    return projection.depth_noise(sensor.noise_m, sensor.noise_per_m, depth)
