"""A z-buffer: which point of a mesh is seen in each pixel."""

import numpy as np
from numba import njit

from inhand_tracker.geometry.arrays import Array, Indices


def nearest_depths(pixels: Array, depths: Array, faces: Indices, size: int) -> Array:
    """(size, size) depth of the nearest surface in each pixel, infinite where there is none.

    ``pixels`` (V, 2) and ``depths`` (V,) are the projected vertices, ``faces`` (F, 3). The edges
    of faces are drawn as lines, so that nothing is too thin to be seen.
    """
    return nearest_faces(pixels, depths, faces, size)[0]


def nearest_faces(pixels: Array, depths: Array, faces: Indices, size: int) -> tuple[Array, Indices]:
    """As ``nearest_depths``, and which face (size, size) is seen there, -1 for none."""
    buffer = np.full((size, size), np.inf)
    owners = np.full((size, size), -1)
    _fill(pixels, depths, faces, buffer, owners)
    return buffer, owners


@njit(cache=True, nogil=True)
def _draw_line(
    ax: float,
    ay: float,
    a_depth: float,
    bx: float,
    by: float,
    b_depth: float,
    buffer: Array,
    owners: Indices,
    face: int,
) -> None:
    height, width = buffer.shape
    steps = max(1, int(np.ceil(max(abs(bx - ax), abs(by - ay)))))
    for step in range(steps + 1):
        share = step / steps
        x = int(np.rint(ax + share * (bx - ax)))
        y = int(np.rint(ay + share * (by - ay)))
        if 0 <= x < width and 0 <= y < height:
            depth = a_depth + share * (b_depth - a_depth)
            if depth < buffer[y, x]:
                buffer[y, x] = depth
                owners[y, x] = face


@njit(cache=True, nogil=True)
def _fill(
    pixels: Array,
    depths: Array,
    faces: Indices,
    buffer: Array,
    owners: Indices,
) -> None:
    height, width = buffer.shape
    for face in range(faces.shape[0]):
        a, b, c = faces[face]
        ax, ay = pixels[a]
        bx, by = pixels[b]
        cx, cy = pixels[c]
        _draw_line(ax, ay, depths[a], bx, by, depths[b], buffer, owners, face)
        _draw_line(bx, by, depths[b], cx, cy, depths[c], buffer, owners, face)
        _draw_line(cx, cy, depths[c], ax, ay, depths[a], buffer, owners, face)
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if abs(area) < 1e-12:
            continue
        left = max(0, int(np.ceil(min(ax, bx, cx))))
        right = min(width - 1, int(np.floor(max(ax, bx, cx))))
        top = max(0, int(np.ceil(min(ay, by, cy))))
        bottom = min(height - 1, int(np.floor(max(ay, by, cy))))
        for y in range(top, bottom + 1):
            for x in range(left, right + 1):
                u = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
                v = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
                w = 1.0 - u - v
                if u >= 0.0 and v >= 0.0 and w >= 0.0:
                    depth = u * depths[a] + v * depths[b] + w * depths[c]
                    if depth < buffer[y, x]:
                        buffer[y, x] = depth
                        owners[y, x] = face
