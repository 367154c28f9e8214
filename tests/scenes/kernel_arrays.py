"""Arrays at random in the shapes that sight's kernels read, and plain look-ups in them."""

from itertools import product

import numpy as np
from inhand_tracker.geometry import rotations
from inhand_tracker.shape.view_grid import view_grid
from inhand_tracker.sight.depth_table import sensor_of
from inhand_tracker.sight.kernels.inputs import Outlines, ScoredPixels
from inhand_tracker.sight.parameters import DEFAULT_SIGHT

WIDTH, HEIGHT = 64, 48
LENS = np.array([70.0, 72.0, 31.3, 23.6], np.float32)
SENSOR = sensor_of(DEFAULT_SIGHT)


def unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def outlines(points: int = 12) -> Outlines:
    """Points on a ball, seen from 26 directions, with normals at random."""
    random = np.random.default_rng(3)
    directions = unit(np.array([d for d in product((-1.0, 0.0, 1.0), repeat=3) if any(d)]))
    singles = directions.astype(np.float32)
    shape = len(directions), 3, points
    vectors = [unit(random.normal(size=shape)).astype(np.float32) for _ in range(4)]
    thickness = random.uniform(0.005, 0.1, (2, len(directions), points)).astype(np.float32)
    return Outlines(
        view_grid(directions),
        singles,
        np.float32(0.06) * vectors[0],
        vectors[1],
        thickness[0],
        thickness[1],
        np.float32(0.06) * vectors[2],
        vectors[3],
        random.uniform(0.05, 0.2, len(directions)).astype(np.float32),
        random.uniform(0.5, 1.5, len(directions)).astype(np.float32),
    )


def pixels(depth: float = 0.5, spread: float = 0.04) -> ScoredPixels:
    """An image of noise, with depths about ``depth`` and no depth in one of ten pixels."""
    random = np.random.default_rng(4)
    depths = random.normal(depth, spread, (HEIGHT, WIDTH))
    return ScoredPixels(
        LENS,
        random.integers(0, 8, (4, HEIGHT, WIDTH)).astype(np.uint8),
        random.normal(size=(4, 8)).astype(np.float32),
        random.normal(size=(HEIGHT, WIDTH, 2)).astype(np.float32),
        (random.random((HEIGHT, WIDTH)) < 0.2).astype(np.uint8),
        np.where(random.random(depths.shape) < 0.1, 0.0, depths).astype(np.float32),
        random.integers(0, 256, (HEIGHT, WIDTH, 3)).astype(np.uint8),
    )


def poses(count: int = 24) -> tuple[np.ndarray, np.ndarray]:
    """Poses (P, 3) and (P, 4), of which some are partly or wholly out of the image."""
    random = np.random.default_rng(5)
    translations = random.normal([0.0, 0.0, 0.5], [0.12, 0.09, 0.03], (count, 3))
    return translations, rotations.normalise(random.normal(size=(count, 4)))


def place(pose: tuple[np.ndarray, np.ndarray], points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points (3, B) of an object turned as in its pose, and moved there too."""
    arms = rotations.to_matrix(pose[1]) @ points
    return arms, arms + pose[0][:, None]


def nearest(directions: np.ndarray, pose: tuple[np.ndarray, np.ndarray]) -> int:
    """The direction (V, 3) from which an object in a pose is seen."""
    return int(np.argmax(directions @ (rotations.to_matrix(pose[1]).T @ -pose[0])))


def project(points: np.ndarray) -> np.ndarray:
    """Pixels (2, B) of points (3, B), counted from the image's corner."""
    return LENS[:2, None] * points[:2] / points[2] + LENS[2:, None] + 0.5


def project_normals(normals: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Unit normals (2, B) in the image of normals (3, B) at points (3, B)."""
    across = LENS[:2, None] * (normals[:2] - normals[2] / points[2] * points[:2])
    return across / np.linalg.norm(across, axis=0)


def is_inside(where: np.ndarray) -> np.ndarray:
    """Which of pixels (2, B) lie in the image."""
    return ((where >= 0.0) & (where < [[WIDTH], [HEIGHT]])).all(axis=0)


def look_up(image: np.ndarray, where: np.ndarray) -> np.ndarray:
    """The values (B, ...) of an image (H, W, ...) at pixels (2, B), 0 beside it."""
    inside = is_inside(where)
    column, row = np.where(inside, where, 0.0).astype(int)
    values = image[row, column].astype(float)
    return values * inside.reshape(-1, *[1] * (values.ndim - 1))


def channels(normals: np.ndarray) -> np.ndarray:
    """The channels (B,) of normals (2, B): to the right, down right, down, down left."""
    return np.rint(np.arctan2(normals[1], normals[0]) / (np.pi / 4.0)).astype(int) % 4
