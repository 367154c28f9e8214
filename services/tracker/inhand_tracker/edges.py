"""The edge likelihood (Darby et al. 2014, section 5.6)."""

import cv2
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

GRADIENT_THRESHOLD = 100.0
SMOOTHING_PIXELS = 2.0


def chamfer_image(grey: NDArray[np.uint8]) -> NDArray[np.float32]:
    """How near each pixel of a luminance image (H, W) is to an edge: 1 on one, 0 far away."""
    across = cv2.Sobel(grey, cv2.CV_32F, 1, 0)
    down = cv2.Sobel(grey, cv2.CV_32F, 0, 1)
    strength = cv2.magnitude(across, down)
    _, edges = cv2.threshold(strength, GRADIENT_THRESHOLD, 1.0, cv2.THRESH_BINARY)
    smooth = np.asarray(cv2.GaussianBlur(edges, (0, 0), SMOOTHING_PIXELS), np.float32)
    top = float(smooth.max())
    return smooth / np.float32(top) if top > 0.0 else smooth


def edge_log_weights(chamfer: NDArray[np.float32], pixels: Array) -> Array:
    """−Σ of each hypothesis, (P,), from its boundary's pixels (P, B, 2).

    Σ = mean (1 − r)² (equation 16); a point outside the image counts as r = 0.
    """
    height, width = chamfer.shape
    rounded = np.rint(np.nan_to_num(pixels, nan=-1.0, posinf=-1.0, neginf=-1.0))
    inside = np.all((rounded >= 0) & (rounded < [width, height]), axis=-1)
    column, row = np.where(inside[..., None], rounded, 0).astype(np.intp).transpose(2, 0, 1)
    nearness = np.where(inside, chamfer[row, column], 0.0)
    return -np.square(1.0 - nearness).mean(axis=-1)
