"""Faces of a mesh to pixels: a z-buffer of depths."""

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array, Indices


@njit(cache=True, nogil=True)
def draw_faces(
    pixels: Array,
    depths: Array,
    faces: Indices,
    buffer: Array,
    owners: Indices,
) -> None:
    """Draw faces (F, 3) of vertices at ``pixels`` (V, 2) and ``depths`` (V,) into a ``buffer``
    (H, W) of depths, and into ``owners`` (H, W) which face is nearest.

    A pixel belongs to a face that its centre lies in, or that has an edge through it.
    """
    height, width = buffer.shape
    for face in range(faces.shape[0]):
        a, b, c = faces[face]
        ax, ay = pixels[a]
        bx, by = pixels[b]
        cx, cy = pixels[c]
        _draw_line(pixels, depths, (a, b), buffer, owners, face)
        _draw_line(pixels, depths, (b, c), buffer, owners, face)
        _draw_line(pixels, depths, (c, a), buffer, owners, face)
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


@njit(cache=True, nogil=True)
def _draw_line(
    pixels: Array,
    depths: Array,
    ends: tuple[int, int],
    buffer: Array,
    owners: Indices,
    face: int,
) -> None:
    """Draw the edge of a face between two vertices."""
    (ax, ay), (bx, by) = pixels[ends[0]], pixels[ends[1]]
    a_depth, b_depth = depths[ends[0]], depths[ends[1]]
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
