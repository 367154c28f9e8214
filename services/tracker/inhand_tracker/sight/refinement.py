"""Moving poses to where a frame's contours and depth fit best: Gauss-Newton steps.

As contour trackers do (Stoiber et al. 2022): across each point of the outline, how likely it is
that the outline lies at each distance, by the colours on both sides and the edges between; and
the distances of the surface from the measured depth along its normals. What nothing is seen of
stays where it is, or where a prior wants it.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.shape.view_grid import nearest_view
from inhand_tracker.sight.kernels import (
    IN_FRONT_M,
    NEAREST_M,
    Outlines,
    Pixels,
    channel_of,
    depth_noise,
    turned,
)

REACHES = tuple(np.geomspace(1.0, 0.12, 8).tolist())
REACH_M, REACH_RAD = 0.05, 0.2
"""How far off a pose may be at first without a prior, and what is left of that step by step."""
SAMPLES = 12
"""On either side of a point of the outline."""
LEAST_STEP_PIXELS = 0.5
WIDEST_EDGE_STEP = 2.5
"""Pixels between samples beyond which edges would be missed."""
CONTOUR_ERROR_M = 0.002
"""What an outline seen from the nearest of the directions, and from far away, errs by."""
IN_FRONT_PER_M, BEHIND_PER_M = 3.0, 1.5
"""How likely another surface is measured just before and behind the object's."""
COLOUR_WEIGHT, LIMB_FACTOR = 3.0, 20.0
"""How much a measured surface is rather another's for its colour, and for a limb's being there."""
TRUST = 0.25
"""How much of the information that adds up here holds in fact, measured on simulated frames."""
DAMPING = np.array([100.0, 100.0, 100.0, 1.0, 1.0, 1.0])
"""Keeps in place what nothing is seen of: 10 cm and 1 rad."""


@dataclass(frozen=True)
class Prior:
    """A Gaussian: ``translation`` (3,), ``rotation`` (4,), and the ``information`` (6, 6) of
    (translation in the camera frame, rotation vector on the left)."""

    translation: Array
    rotation: Array
    information: Array

    def reach(self) -> tuple[float, float]:
        """The root mean squares of its translation and rotation, in metres and radians."""
        variances = np.diag(np.linalg.inv(self.information))
        return float(np.sqrt(variances[:3].sum())), float(np.sqrt(variances[3:].sum()))

    def log_density(self, translations: Array, orientations: Array) -> Array:
        """Of poses (K, 3) and (K, 4), (K,), up to a constant."""
        turns = rotations.multiply(orientations, rotations.conjugate(self.rotation))
        off = np.concatenate((translations - self.translation, rotations.to_vector(turns)), axis=1)
        return -0.5 * np.einsum("ki,ij,kj->k", off, self.information, off)

    def added_to(
        self, information: Array, gradients: Array, translations: Array, orientations: Array
    ) -> tuple[Array, Array]:
        """Information (K, 6, 6) and gradients (K, 6) at poses with what the prior says of them."""
        turns = rotations.multiply(self.rotation, rotations.conjugate(orientations))
        off = np.concatenate((self.translation - translations, rotations.to_vector(turns)), axis=1)
        return information + self.information, gradients + off @ self.information


@dataclass(frozen=True)
class Refined:
    """Poses (K, 3) and (K, 4), and ``information`` (K, 6, 6), what the image alone says of each,
    in the order of ``Prior.information``; none of a pose that could not be made likelier."""

    translations: Array
    rotations: Array
    information: Array


@njit(cache=True, nogil=True, inline="always")
def _add(
    information: Array,
    gradient: Array,
    across: Array,
    arm: Array,
    residual: float,
    weight: float,
) -> None:
    """One measurement: the point at ``arm`` (3,) from the origin lies off by ``residual`` along
    ``across`` (3,)."""
    row = np.empty(6)
    row[:3] = across
    row[3] = arm[1] * across[2] - arm[2] * across[1]
    row[4] = arm[2] * across[0] - arm[0] * across[2]
    row[5] = arm[0] * across[1] - arm[1] * across[0]
    for i in range(6):
        gradient[i] += weight * residual * row[i]
        for j in range(6):
            information[i, j] += weight * row[i] * row[j]


@njit(cache=True, nogil=True)
def gather(
    translations: Array,
    orientations: Array,
    outlines: Outlines,
    pixels: Pixels,
    returned: float,
    wanted: Flags,
    reach_m: float,
    reach_rad: float,
    weights: Array,
    information: Array,
    gradients: Array,
) -> None:
    """Add up what a frame says of each of poses (K, 3), (K, 4): ``information`` (K, 6, 6) and
    ``gradients`` (K, 6).

    ``wanted`` (3,): edges, colours, depth; ``weights`` (2,): how much a point of the outline and of
    the surface counts, which are not independent of each other.
    """
    grid, directions, points, normals, inside, outside, surface_points, surface_normals, _ = (
        outlines
    )
    lens, edges, edge_scores, colour_scores, limbs, depth = pixels
    height, width = limbs.shape
    fx, fy, cx, cy = lens
    across, arm = np.empty(3), np.empty(3)
    log_posterior = np.empty(2 * SAMPLES + 1)
    inner, outer = np.empty(2 * SAMPLES + 1), np.empty(2 * SAMPLES + 1)
    for pose in range(len(translations)):
        tx, ty, tz = translations[pose]
        w, x, y, z = orientations[pose]
        r0, r1, r2, r3, r4, r5, r6, r7, r8 = turned(w, x, y, z)
        view = nearest_view(
            grid,
            directions,
            -(r0 * tx + r3 * ty + r6 * tz),
            -(r1 * tx + r4 * ty + r7 * tz),
            -(r2 * tx + r5 * ty + r8 * tz),
        )
        for point in range(points.shape[2]):
            if not (wanted[0] or wanted[1]):
                break
            a, b, c = points[view, :, point]
            arm[0] = r0 * a + r1 * b + r2 * c
            arm[1] = r3 * a + r4 * b + r5 * c
            arm[2] = r6 * a + r7 * b + r8 * c
            px, py, pz = arm[0] + tx, arm[1] + ty, arm[2] + tz
            length = np.sqrt(arm[0] * arm[0] + arm[1] * arm[1] + arm[2] * arm[2])
            reach = reach_m + reach_rad * length
            if pz < NEAREST_M:
                continue
            u, v = fx * px / pz + cx, fy * py / pz + cy
            if not (u > -0.5 and v > -0.5 and u < width - 0.5 and v < height - 0.5):
                continue
            column, row = int(u + 0.5), int(v + 0.5)
            measured = depth[row, column]
            if measured > 0.0 and measured < pz - IN_FRONT_M - 2.0 * depth_noise(pz) - reach:
                continue
            a, b, c = normals[view, :, point]
            nz = (r6 * a + r7 * b + r8 * c) / pz
            nx = fx * (r0 * a + r1 * b + r2 * c - nz * px)
            ny = fy * (r3 * a + r4 * b + r5 * c - nz * py)
            length = np.sqrt(nx * nx + ny * ny)
            if length < 1e-9:
                continue
            nx, ny = nx / length, ny / length
            step = max(reach * fx / pz / SAMPLES, LEAST_STEP_PIXELS)
            within = inside[view, point] * fx / pz
            beside = outside[view, point] * fx / pz
            channel = channel_of(nx, ny)
            for sample in range(2 * SAMPLES + 1):
                away = (sample - SAMPLES) * step
                inner[sample] = outer[sample] = log_posterior[sample] = 0.0
                su, sv = u + away * nx, v + away * ny
                if not (su > -0.5 and sv > -0.5 and su < width - 0.5 and sv < height - 0.5):
                    continue
                column, row = int(su + 0.5), int(sv + 0.5)
                if wanted[1] and -away < within and away < beside:
                    inner[sample] = step * colour_scores[row, column, 0]
                    outer[sample] = step * colour_scores[row, column, 1]
                if wanted[0] and step < WIDEST_EDGE_STEP and not limbs[row, column]:
                    log_posterior[sample] = edge_scores[channel, edges[channel, row, column]]
            total = 0.0
            for sample in range(2 * SAMPLES + 1):
                total += outer[sample]
            before = 0.0
            most = -1e30
            for sample in range(2 * SAMPLES + 1):
                # Half of the pixel that the outline runs through is on either side.
                middle = 0.5 * (inner[sample] - outer[sample])
                log_posterior[sample] += before + middle
                before += 2.0 * middle
                most = max(most, log_posterior[sample])
            mass = mean = square = 0.0
            for sample in range(2 * SAMPLES + 1):
                away = (sample - SAMPLES) * step
                share = np.exp(log_posterior[sample] - most)
                mass += share
                mean += share * away
                square += share * away * away
            mean /= mass
            variance = square / mass - mean * mean + 0.5 * step * step + 0.25
            variance += np.square(CONTOUR_ERROR_M * fx / pz)
            flat = SAMPLES * (SAMPLES + 1) * step * step / 3.0
            certainty = 1.0 / variance - 1.0 / flat
            if certainty <= 0.0:
                continue
            # The pixel's displacement along (nx, ny) by a displacement of the point.
            across[0] = nx * fx / pz
            across[1] = ny * fy / pz
            across[2] = -(nx * fx * px + ny * fy * py) / (pz * pz)
            _add(information[pose], gradients[pose], across, arm, mean, weights[0] * certainty)
        for point in range(surface_points.shape[2]):
            if not wanted[2]:
                break
            a, b, c = surface_points[view, :, point]
            arm[0] = r0 * a + r1 * b + r2 * c
            arm[1] = r3 * a + r4 * b + r5 * c
            arm[2] = r6 * a + r7 * b + r8 * c
            px, py, pz = arm[0] + tx, arm[1] + ty, arm[2] + tz
            length = np.sqrt(arm[0] * arm[0] + arm[1] * arm[1] + arm[2] * arm[2])
            reach = reach_m + reach_rad * length
            if pz < NEAREST_M:
                continue
            u, v = fx * px / pz + cx, fy * py / pz + cy
            if not (u > -0.5 and v > -0.5 and u < width - 0.5 and v < height - 0.5):
                continue
            column, row = int(u + 0.5), int(v + 0.5)
            measured = depth[row, column]
            if measured <= 0.0:
                continue
            error = measured - pz
            noise = depth_noise(pz)
            width_m = np.sqrt(noise * noise + reach * reach / 3.0)
            near = np.exp(-0.5 * error * error / (width_m * width_m)) / (2.5066 * width_m)
            other = (IN_FRONT_PER_M if error < 0.0 else BEHIND_PER_M) / max(returned, 0.01)
            if wanted[1]:
                # A colour of the surroundings rather than the object's tells whose surface it is.
                against = colour_scores[row, column, 1] - colour_scores[row, column, 0]
                other *= np.exp(COLOUR_WEIGHT * against)
            if limbs[row, column]:
                other *= LIMB_FACTOR
            a, b, c = surface_normals[view, :, point]
            across[0] = r0 * a + r1 * b + r2 * c
            across[1] = r3 * a + r4 * b + r5 * c
            across[2] = r6 * a + r7 * b + r8 * c
            # The measured point lies on the same ray, ``measured`` away.
            share = measured / pz - 1.0
            residual = share * (across[0] * px + across[1] * py + across[2] * pz)
            spread = width_m * max(abs(across[2]), 0.2)
            certainty = near / (near + other) / (spread * spread)
            _add(information[pose], gradients[pose], across, arm, residual, weights[1] * certainty)
