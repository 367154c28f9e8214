"""What a projector's sensor would read of a scene without noise: disparities, edges and shadows."""

from __future__ import annotations

import numpy as np
from inhand_runtime.compiled import njit

from inhand_lab.sensing.depth_scene import steps_at_one_metre

Area = tuple[int, int, int, int]
"""Top, bottom, left and right of a part of an image; bottom and right are not in it."""


@njit(cache=True, nogil=True)
def find_disparities(scene, area, noise):  # type: ignore[no-untyped-def]
    """Disparities in steps of the pixels of an area, and their relative deviations.

    A disparity is negative at an edge, and 0 of what is too near, too far or unseen; its deviation
    is then 0 as well.
    """
    top, bottom, left, right = area
    disparities = np.empty((bottom - top, right - left), np.float32)
    deviations = np.empty_like(disparities)
    for v in range(top, bottom):
        row, above = scene.inverse_depth[v], scene.inverse_depth[max(v - 1, 0)]
        measured = disparities[v - top]
        _find_steps(row, above, left, noise, measured)
        if scene.unseen != 0:
            for u in range(left, right):
                if scene.labels[v, u] == scene.unseen:
                    measured[u - left] = 0.0
        _find_deviations(row[left:right], measured, noise, deviations[v - top])
    return disparities, deviations


@njit(cache=True, nogil=True)
def _find_deviations(inverse_depth, disparities, noise, deviations):  # type: ignore[no-untyped-def]
    least, growth = np.float32(noise.least_deviation), np.float32(noise.deviation_growth)
    most_exact = np.float32(noise.most_exact)
    for u in range(len(disparities)):
        measured = disparities[u] != 0.0
        inverse = inverse_depth[u] if measured else np.float32(1.0)
        beyond = np.float32(1.0) / inverse - most_exact
        deviation = (least + growth * beyond * beyond) * inverse
        deviations[u] = deviation if measured else np.float32(0.0)


@njit(cache=True, nogil=True)
def _find_steps(inverse_depth, above, left, noise, disparities):  # type: ignore[no-untyped-def]
    """Disparities of the pixels of a row that begin with the column ``left``."""
    steps, edge_jump = steps_at_one_metre(noise), noise.edge_jump
    least, most = 1.0 / noise.furthest, 1.0 / noise.nearest
    for index in range(len(disparities)):
        u = left + index
        inverse = inverse_depth[u]
        jump = max(abs(inverse_depth[max(u - 1, 0)] - inverse), abs(above[u] - inverse))
        sign = np.float32(-1.0) if jump > edge_jump * inverse else np.float32(1.0)
        seen = inverse >= least and inverse <= most
        disparities[index] = sign * (steps * inverse) if seen else np.float32(0.0)


@njit(cache=True, nogil=True)
def shade(inverse_depth, focal, noise, left, right, disparities):  # type: ignore[no-untyped-def]
    """Take away the disparities of a row's pixels that something nearer hides from the projector.

    Outside the columns from ``left`` to ``right`` stands the still room, whose own shadows were
    taken away before: to the right nothing changes, to the left what stands between may shade it.
    """
    parallax, shadow = np.float32(focal * noise.baseline), np.float32(noise.shadow)
    lit_from = _first_lit(inverse_depth, parallax, right)
    for u in range(right - 1, left - 1, -1):
        place = u - parallax * inverse_depth[u]
        if place > lit_from + shadow:
            disparities[u] = 0.0
        lit_from = min(lit_from, place)
    # The projector sees every pixel to the left of where it is, or there.
    for u in range(left - 1, max(int(lit_from + shadow), 0) - 1, -1):
        if u - parallax * inverse_depth[u] > lit_from + shadow:
            disparities[u] = 0.0


@njit(cache=True, nogil=True, fastmath={"nnan", "nsz"})
def _first_lit(inverse_depth, parallax, right):  # type: ignore[no-untyped-def]
    """Leftmost place at which the projector sees a pixel of a row from the column ``right`` on."""
    first = 1e9
    for u in range(right, len(inverse_depth)):
        first = min(first, u - parallax * inverse_depth[u])
    return first
