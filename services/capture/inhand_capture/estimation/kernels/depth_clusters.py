"""Surfaces in a small window of a depth image, as groups of like depths."""

import numpy as np
from inhand_runtime.compiled import njit


@njit(cache=True, nogil=True)
def window_depths(depth, unit, x, y, reach):  # type: ignore[no-untyped-def]
    """Return the measured depths (N,), in metres and sorted, in a disc of a depth image.

    ``depth`` (H, W) is in units of so many metres, 0 where nothing was measured; the disc's middle
    and its ``reach`` are in pixels.
    """
    height, width = depth.shape
    column, row, whole = round(x), round(y), int(reach)
    measured = np.empty((2 * whole + 1) ** 2, np.float64)
    count = 0
    for v in range(max(row - whole, 0), min(row + whole + 1, height)):
        for u in range(max(column - whole, 0), min(column + whole + 1, width)):
            inside = (v - row) ** 2 + (u - column) ** 2 <= reach * reach + 0.5
            if inside and depth[v, u] > 0:
                measured[count] = unit * depth[v, u]
                count += 1
    return np.sort(measured[:count])


@njit(cache=True, nogil=True)
def clusters(ordered, gap, fewest, most):  # type: ignore[no-untyped-def]
    """Return the largest clusters of sorted depths (N,): their medians (K,) and shares (K,).

    Depths further apart than a gap, as a share of their distance, are of two clusters. One of fewer
    than ``fewest`` depths does not count, and no more than ``most`` are returned.
    """
    middles, shares = np.empty(len(ordered)), np.empty(len(ordered))
    count = begin = 0
    for end in range(1, len(ordered) + 1):
        if end < len(ordered) and ordered[end] - ordered[end - 1] <= gap * ordered[end]:
            continue
        if end - begin >= fewest:
            middles[count] = 0.5 * (ordered[(begin + end - 1) // 2] + ordered[(begin + end) // 2])
            shares[count] = (end - begin) / len(ordered)
            count += 1
        begin = end
    largest = np.argsort(-shares[:count])[:most]
    return middles[largest], shares[largest]


@njit(cache=True, nogil=True)
def surfaces_about(depth, unit, pixels, reaches, radii, distances, numbers):  # type: ignore[no-untyped-def]
    """Return the depths (J, K) at which joints may lie, their shares (J, K) of the measured pixels
    about them, and how many there are, (J,).

    ``pixels`` (J, 2) may be NaN; ``reaches`` (J,) are in pixels, ``radii`` (J,), by which joints
    lie below a surface, in metres. ``distances`` are the gap between clusters, a share, and the
    least depth, metres; ``numbers`` the fewest pixels of a cluster, and the most clusters K.
    """
    joints = len(pixels)
    places, shares = np.zeros((joints, numbers[1])), np.zeros((joints, numbers[1]))
    counts = np.zeros(joints, np.int64)
    for joint in range(joints):
        x, y = pixels[joint]
        if not (abs(x) < 1e6 and abs(y) < 1e6):
            continue
        ordered = window_depths(depth, unit, x, y, reaches[joint])
        ordered = ordered[np.searchsorted(ordered, distances[1]) :]
        middles, parts = clusters(ordered, distances[0], numbers[0], numbers[1])
        counts[joint] = len(middles)
        for one in range(len(middles)):
            places[joint, one] = middles[one] + radii[joint]
            shares[joint, one] = parts[one]
    return places, shares, counts
