"""Somebody who stands still, while the wedge is at one of two places."""

from dataclasses import replace
from functools import lru_cache

import cv2
import numpy as np
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.learning import learn
from inhand_tracker.model.model import Model
from people import STANDING, quaternion_of, scipy_rotation, wave_model
from scipy.spatial.transform import Rotation

CAMERA = Intrinsics(525.0, 525.0, 319.5, 239.5, 640, 480)
SIDES = (np.array([-0.16, -0.13, 2.0]), np.array([-0.32, -0.13, 2.0]))
UPRIGHT = quaternion_of(Rotation.from_rotvec([0.5, 0.3, 0.2]))


def wedge_silhouette(translation: np.ndarray, rotation: np.ndarray, value: int = 220) -> np.ndarray:
    """The wedge (which is convex) drawn bright on black."""
    corners = scipy_rotation(rotation).apply(wave_model().shape.vertices) + translation
    pixels = corners[:, :2] / corners[:, 2:] * 525.0 + [319.5, 239.5]
    grey = np.zeros((480, 640), np.uint8)
    cv2.fillConvexPoly(grey, cv2.convexHull(np.rint(pixels).astype(np.int32)), value)
    return grey


@lru_cache(maxsize=1)
def two_sided_model() -> Model:
    """A person who stands still, while the object is at one of two places 16 cm apart."""
    joints = np.repeat(STANDING[None], 40, axis=0)
    turns = np.tile(UPRIGHT, (40, 1))
    sequences = [
        LabelledSequence(f"p{i}", False, joints, np.repeat(SIDES, 20, axis=0)[:: 1 - 2 * i], turns)
        for i in range(2)
    ]
    return replace(wave_model(), mapping=learn(sequences, np.array([1.0, 0.0, 0.0])))
