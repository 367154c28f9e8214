"""What a prior predicts for bodies, frame after frame, and how far it is off."""

import numpy as np
from inhand_tracker.body import skeleton as body
from inhand_tracker.body.anchors import find_anchors
from inhand_tracker.body.window import BodyWindow
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.prior.prior import Prediction, Prior, predict
from people import FRAME_NS, held, scipy_rotation, waving, wedge
from scipy.spatial.transform import Rotation

MIDDLE = wedge().marked_vertices.mean(axis=0)


def height_of(joints: np.ndarray) -> float:
    return body.stature_of(joints)


def predictions(prior: Prior, joints: np.ndarray) -> list[Prediction]:
    """Frame after frame, as a tracker asks for them."""
    window, height = BodyWindow(), height_of(joints)
    return [
        predict(prior, window.add(one, (n + 1) * FRAME_NS, height), find_anchors(one), height)
        for n, one in enumerate(joints)
    ]


def middle(one: LabelledSequence) -> np.ndarray:
    return one.translations + scipy_rotation(one.rotations).apply(MIDDLE)


def deviations(predicted: list[Prediction], true: LabelledSequence) -> np.ndarray:
    """(T, 6): translation of the middle and rotation vector on the left."""
    centres = np.array([one.centre for one in predicted]) - middle(true)
    turns = Rotation.from_matrix([one.rotation for one in predicted])
    return np.column_stack((centres, (turns * scipy_rotation(true.rotations).inv()).as_rotvec()))


def strangers(count: int) -> list[LabelledSequence]:
    """They wave as fast as those learned from, and are others."""
    found = []
    for number in range(count):
        joints = waving(60, seed=20 + number, speed=0.2 + 0.02 * number)
        places, turns = held(joints, seed=20 + number)
        found.append(LabelledSequence(f"s{number}", False, joints, places, turns))
    return found
