"""What may be wrong with a body's joints (T, 20, 3); each function changes what it is given."""

from collections.abc import Callable

import numpy as np
from people import RIGHT_ARM


def nobody(joints: np.ndarray) -> np.ndarray:
    return np.full_like(joints, np.nan)


def no_arm(joints: np.ndarray) -> np.ndarray:
    joints[:, [9, *RIGHT_ARM]] = np.nan
    return joints


def pelvis_only(joints: np.ndarray) -> np.ndarray:
    joints[:, [n for n in range(20) if n not in (0, 12, 16)]] = np.nan
    return joints


def one_point(joints: np.ndarray) -> np.ndarray:
    return np.tile([0.0, 0.0, 2.0], (len(joints), 20, 1))


def at_the_camera(joints: np.ndarray) -> np.ndarray:
    return joints - [0.0, 0.0, 2.2]


def behind_the_camera(joints: np.ndarray) -> np.ndarray:
    return joints * [1.0, 1.0, -1.0]


def out_of_the_image(joints: np.ndarray) -> np.ndarray:
    return joints + np.array([40.0, 0.0, 0.0])


def infinite(joints: np.ndarray) -> np.ndarray:
    joints[:, 11] = np.inf
    return joints


def enormous(joints: np.ndarray) -> np.ndarray:
    return 1e150 * joints


def flickering(joints: np.ndarray) -> np.ndarray:
    joints[np.random.default_rng(0).random(joints.shape[:2]) < 0.4] = np.nan
    return joints


def scattered(metres: float) -> Callable[[np.ndarray], np.ndarray]:
    def scatter(joints: np.ndarray) -> np.ndarray:
        return joints + metres * np.random.default_rng(0).normal(size=joints.shape)

    return scatter


FAULTS = [
    nobody,
    no_arm,
    pelvis_only,
    one_point,
    at_the_camera,
    behind_the_camera,
    out_of_the_image,
    infinite,
    enormous,
    flickering,
    scattered(0.3),
    scattered(3.0),
    scattered(50.0),
]
