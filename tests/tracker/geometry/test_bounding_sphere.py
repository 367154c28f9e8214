"""A sphere goes where its object's pose goes."""

import numpy as np
from inhand_tracker.geometry.bounding_sphere import BoundingSphere
from people import quaternion_of
from scipy.spatial.transform import Rotation

SPHERE = BoundingSphere(np.array([0.1, -0.2, 0.3]), 0.25)
TURNS = Rotation.from_rotvec([[0.4, 1.0, -0.3], [0.0, 0.0, 2.0]])


def test_the_origin_is_an_arm_away_from_the_centre() -> None:
    translations = np.array([[0.0, 1.0, 2.0], [3.0, 0.5, 1.0]])
    centres = translations + TURNS.apply(SPHERE.centre)
    turns = quaternion_of(TURNS)
    np.testing.assert_allclose(SPHERE.origins(centres, turns), translations, atol=1e-12)
    for centre, turn, translation in zip(centres, turns, translations, strict=True):
        np.testing.assert_allclose(centre - SPHERE.arm(turn), translation, atol=1e-12)


def test_its_ends_lie_on_it_opposite_in_pairs_and_turn_along() -> None:
    centre = np.array([0.0, 0.0, 2.0])
    offsets = SPHERE.ends(centre, quaternion_of(TURNS[0])) - centre
    np.testing.assert_allclose(np.linalg.norm(offsets, axis=1), SPHERE.radius)
    np.testing.assert_allclose(offsets[:3], -offsets[3:])
    np.testing.assert_allclose(offsets[:3] / SPHERE.radius, TURNS[0].as_matrix().T, atol=1e-12)
