"""Compiled drawing of depth is what its definition in NumPy draws, with OpenCV's lens."""

import cv2
import numpy as np
from inhand_tracker.geometry.rotations import from_vector, to_matrix

from inhand.imports.kernels.depth_alignment import NOTHING, draw_depth, through_lens

DISTORTION = np.array([-1.06, -1.4, 0.0007, -0.001, 1.75, -1.15, -1.19, 1.62])
LENS = np.array([50.0, 55.0, 41.0, 22.0])
MATRIX = np.array([[50.0, 0.0, 41.0], [0.0, 55.0, 22.0], [0.0, 0.0, 1.0]])
WIDEST, SCALE, CLOSEST_M, OVERLAP = 0.9, 0.001, 0.2, 0.25
SHAPE = 48, 80


def projected(points: np.ndarray) -> np.ndarray:
    """Pixels (..., 2) of points (..., 3), NaN where they are too near or too far aside."""
    flat = points.reshape(-1, 3)
    pixels = cv2.projectPoints(flat, np.zeros(3), np.zeros(3), MATRIX, DISTORTION)[0][:, 0]
    aside = np.hypot(flat[:, 0], flat[:, 1]) > WIDEST * flat[:, 2]
    pixels[aside | (flat[:, 2] <= CLOSEST_M)] = np.nan
    return pixels.reshape(*points.shape[:-1], 2)


def defined(depth: np.ndarray, rays: np.ndarray, motion: np.ndarray) -> np.ndarray:
    metres = depth[..., None] * SCALE
    ends = [np.concatenate((part * metres, metres), -1) for part in (rays[:-1, :-1], rays[1:, 1:])]
    points = np.stack(ends) @ motion[:, :3].T + motion[:, 3]
    pixels, units = projected(points), np.round(points[..., 2].mean(axis=0) / SCALE)
    drawn = np.full(SHAPE, NOTHING)
    for place in np.argwhere((depth > 0) & np.isfinite(pixels.sum(axis=(0, -1)))):
        begin = np.ceil(pixels[:, *place].min(axis=0) - OVERLAP).clip(0).astype(int)
        end = np.floor(pixels[:, *place].max(axis=0) + OVERLAP).astype(int).clip(-1) + 1
        square = drawn[begin[1] : end[1], begin[0] : end[0]]
        square[...] = np.minimum(square, units[*place])
    return drawn


def test_depth_is_drawn_as_it_is_defined() -> None:
    chance = np.random.default_rng(7)
    depth = chance.integers(0, 3000, (30, 40)).astype(np.uint16)
    depth[10:20, 5:12] = 0
    x, y = np.meshgrid(np.linspace(-0.8, 0.8, 41), np.linspace(-0.6, 0.6, 31))
    rays = np.stack((x, y), -1)
    rays[3, 4] = np.nan
    turn = to_matrix(from_vector(np.array([0.1, -0.2, 0.3])))
    motion = np.column_stack((turn, (-0.03, 0.01, 0.02)))
    drawn = np.full(SHAPE, NOTHING, np.uint16)
    view, limits = (LENS, DISTORTION, WIDEST), (SCALE, CLOSEST_M, OVERLAP)
    draw_depth(depth, rays, motion, view, limits, drawn)
    true = defined(depth, rays, motion)
    assert 0.3 < np.mean(true < NOTHING) < 1.0
    np.testing.assert_array_equal(drawn, true)


def test_a_lens_is_opencvs() -> None:
    for x, y in ((0.0, 0.0), (0.3, -0.2), (-0.7, 0.4)):
        pixel = through_lens(x, y, LENS, DISTORTION, WIDEST)
        np.testing.assert_allclose(pixel, projected(np.array([x, y, 1.0])), atol=1e-9)
    assert np.isnan(through_lens(0.9, 0.1, LENS, DISTORTION, WIDEST)).all()
