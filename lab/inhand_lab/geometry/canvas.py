"""Painting shaded triangles as a camera sees them, nearest first, on a canvas.

The tracker draws as well (``inhand_tracker.shape.raster``), but something else: every side of a
mesh, whichever way it faces, with lines along its edges so that the thinnest rod is whole, and
depths that are exact between the corners as seen from far away. A picture wants what a camera
sees: perspective, faces turned to it, colours, and many pictures a second, in float32. One kernel
would be two behind one name.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_runtime.compiled import njit
from inhand_tracker.geometry.arrays import Bytes, Singles
from inhand_tracker.geometry.camera import Intrinsics
from numpy.typing import NDArray

NEAREST_PAINTED_M = 0.10
"""Distance, in metres, below which a corner leaves its whole triangle out: no simulated camera
measures so near."""


@dataclass(frozen=True)
class Canvas:
    """An image being drawn: colour (H, W, 3) RGB, inverse depth (H, W) in 1/m, labels (H, W).

    Where nothing was drawn the inverse depth and the label are 0.
    """

    colour: Bytes
    inverse_depth: Singles
    labels: Bytes

    @classmethod
    def blank(cls, intrinsics: Intrinsics) -> Canvas:
        """Return a canvas on which nothing was drawn yet."""
        shape = (intrinsics.height, intrinsics.width)
        return cls(
            np.zeros((*shape, 3), np.uint8), np.zeros(shape, np.float32), np.zeros(shape, np.uint8)
        )

    def copy(self) -> Canvas:
        """Return a copy to draw on."""
        return Canvas(self.colour.copy(), self.inverse_depth.copy(), self.labels.copy())

    def depth_in_millimetres(self) -> NDArray[np.uint16]:
        """Depth (H, W) along the optical axis, 0 where nothing was drawn."""
        return np.asarray(_to_millimetres(self.inverse_depth))


def draw_triangles(
    canvas: Canvas,
    intrinsics: Intrinsics,
    vertices: Singles,
    faces: NDArray[np.int32],
    shades: Singles,
    label: int,
) -> None:
    """Draw the triangles that face the camera and are nearer than what is there.

    ``vertices`` (V, 3) are in the camera frame in metres, ``faces`` (F, 3) counter-clockwise from
    outside, ``shades`` (V, 3) RGB from 0 to 255.
    """
    _draw(
        vertices,
        faces,
        shades,
        (intrinsics.fx, intrinsics.fy, intrinsics.cx, intrinsics.cy),
        label,
        canvas.colour,
        canvas.inverse_depth,
        canvas.labels,
    )


@njit(cache=True, nogil=True, fastmath=True)
def _draw(vertices, faces, shades, lens, label, colour, inverse_depth, labels):  # type: ignore[no-untyped-def]
    height, width = inverse_depth.shape
    fx, fy, cx, cy = lens
    for face in range(faces.shape[0]):
        a, b, c = faces[face, 0], faces[face, 1], faces[face, 2]
        za, zb, zc = vertices[a, 2], vertices[b, 2], vertices[c, 2]
        if min(za, zb, zc) < NEAREST_PAINTED_M:
            continue
        wa, wb, wc = 1.0 / za, 1.0 / zb, 1.0 / zc
        ua, va = fx * vertices[a, 0] * wa + cx, fy * vertices[a, 1] * wa + cy
        ub, vb = fx * vertices[b, 0] * wb + cx, fy * vertices[b, 1] * wb + cy
        uc, vc = fx * vertices[c, 0] * wc + cx, fy * vertices[c, 1] * wc + cy
        area = (ub - ua) * (vc - va) - (uc - ua) * (vb - va)
        if area >= -1e-12:
            continue
        left, right = max(int(np.ceil(min(ua, ub, uc))), 0), min(int(max(ua, ub, uc)), width - 1)
        top, bottom = max(int(np.ceil(min(va, vb, vc))), 0), min(int(max(va, vb, vc)), height - 1)
        if max(ua, ub, uc) < 0.0 or max(va, vb, vc) < 0.0:
            continue
        scale = 1.0 / area
        step_b, step_c = (vc - va) * scale, -(vb - va) * scale
        for v in range(top, bottom + 1):
            share_b = ((left - ua) * (vc - va) - (uc - ua) * (v - va)) * scale
            share_c = ((ub - ua) * (v - va) - (left - ua) * (vb - va)) * scale
            entered = False
            for u in range(left, right + 1):
                share_a = 1.0 - share_b - share_c
                if share_a >= 0.0 and share_b >= 0.0 and share_c >= 0.0:
                    entered = True
                    inverse = share_a * wa + share_b * wb + share_c * wc
                    if inverse > inverse_depth[v, u]:
                        inverse_depth[v, u] = inverse
                        labels[v, u] = label
                        for channel in range(3):
                            colour[v, u, channel] = np.uint8(
                                share_a * shades[a, channel]
                                + share_b * shades[b, channel]
                                + share_c * shades[c, channel]
                            )
                elif entered:
                    break
                share_b += step_b
                share_c += step_c


@njit(cache=True, nogil=True)
def _to_millimetres(inverse_depth):  # type: ignore[no-untyped-def]
    height, width = inverse_depth.shape
    depth = np.zeros((height, width), np.uint16)
    for v in range(height):
        for u in range(width):
            if inverse_depth[v, u] > 0.0:
                depth[v, u] = min(int(1000.0 / inverse_depth[v, u] + 0.5), 65535)
    return depth
