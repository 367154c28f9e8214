"""The edge likelihood (Darby et al. 2014, section 5.6)."""

import cv2
import numpy as np
from inhand_runtime.compiled import njit
from numpy.typing import NDArray

from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.geometry.camera import NEAREST_M
from inhand_tracker.geometry.image import Image
from inhand_tracker.methods.darby2014.parameters import DEFAULT_EDGE_IMAGE, EdgeImageParameters
from inhand_tracker.sight.kernels.projection import (
    in_image,
    projected,
    rotated,
    rotation_matrix,
    view_of_pose,
)


def chamfer_of(image: Image) -> Singles | None:
    """Nearness of each pixel (H, W) of an image to an edge; None where there is no luminance."""
    return None if image.grey is None else chamfer_image(image.grey)


def chamfer_image(grey: Bytes, parameters: EdgeImageParameters = DEFAULT_EDGE_IMAGE) -> Singles:
    """Nearness of each pixel of a luminance image (H, W) to an edge: 1 on one, 0 far away."""
    across = cv2.Sobel(grey, cv2.CV_32F, 1, 0)
    down = cv2.Sobel(grey, cv2.CV_32F, 0, 1)
    strength = cv2.magnitude(across, down)
    _, edges = cv2.threshold(strength, parameters.gradient_threshold, 1.0, cv2.THRESH_BINARY)
    smooth = np.asarray(cv2.GaussianBlur(edges, (0, 0), parameters.smoothing_pixels), np.float32)
    top = float(smooth.max())
    return smooth / np.float32(top) if top > 0.0 else smooth


def edge_log_weights(chamfer: Singles, pixels: Array) -> Array:
    """−Σ of each hypothesis, (P,), from its boundary's pixels (P, B, 2).

    Σ = mean (1 − r)² (equation 16); a point outside the image counts as r = 0. This is the
    definition; ``weigh_by_edges`` gives the same for poses, and many times faster.
    """
    height, width = chamfer.shape
    rounded = np.rint(np.nan_to_num(pixels, nan=-1.0, posinf=-1.0, neginf=-1.0))
    inside = np.all((rounded >= 0) & (rounded < [width, height]), axis=-1)
    column, row = np.where(inside[..., None], rounded, 0).astype(np.intp).transpose(2, 0, 1)
    nearness = np.where(inside, chamfer[row, column], 0.0)
    return -np.square(1.0 - nearness).mean(axis=-1)


@njit(cache=True, nogil=True, fastmath={"nsz", "arcp", "contract", "afn", "reassoc"})
def weigh_by_edges(
    translations: Array,
    orientations: Array,
    grid: NDArray[np.int16],
    directions: Array,
    boundaries: Array,
    lens: Array,
    chamfer: Singles,
    log_weights: Array,
) -> None:
    """Fill ``log_weights`` (P,) with −Σ of each pose (P, 3) and (P, 4).

    The ``boundaries`` (V, 3, B) are seen from the nearest of the ``directions`` (V, 3), which
    ``grid`` finds (``view_grid``); ``lens`` is (fx, fy, cx, cy).
    """
    height, width = chamfer.shape
    corner_lens = lens[0], lens[1], lens[2] + 0.5, lens[3] + 0.5
    count = boundaries.shape[2]
    u, v = np.empty(count), np.empty(count)
    for pose in range(len(translations)):
        tx, ty, tz = translations[pose, 0], translations[pose, 1], translations[pose, 2]
        turn = rotation_matrix(
            orientations[pose, 0],
            orientations[pose, 1],
            orientations[pose, 2],
            orientations[pose, 3],
        )
        view = view_of_pose(grid, directions, turn, tx, ty, tz)
        for point in range(count):
            a, b, c = (
                boundaries[view, 0, point],
                boundaries[view, 1, point],
                boundaries[view, 2, point],
            )
            x, y, z = rotated(turn, a, b, c)
            depth = z + tz
            column, row = projected(corner_lens, x + tx, y + ty, depth)
            u[point], v[point] = column if depth > NEAREST_M else -1.0, row
        total = 0.0
        for point in range(count):
            if in_image(u[point], v[point], width, height):
                away = 1.0 - chamfer[int(v[point]), int(u[point])]
                total += away * away
            else:
                total += 1.0
        log_weights[pose] = -total / count
