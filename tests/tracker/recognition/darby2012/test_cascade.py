"""The published cascade on two actions of one pose each: which it is, and where its object."""

from types import SimpleNamespace

import numpy as np
import pytest
from inhand_tracker.body.skeleton import (
    PARTS,
    body_pose,
    part_bases,
    part_lengths,
    pelvis_basis,
    stature,
)
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.recognition.darby2012.cascade import Cascade2012
from inhand_tracker.recognition.pairwise_svm import PairwiseSvm
from people import FRAME_NS, STANDING, same_rotation

CAMERA = Intrinsics(500.0, 500.0, 320.0, 240.0, 640, 480)
RAISED = STANDING - [0.0, 0.3, 0.0] * (np.arange(20) == 11)[:, None]
PLACE = np.array([0.1, -0.2, 2.0])
UNTURNED = np.array([1.0, 0.0, 0.0, 0.0])


def height_of(joints: np.ndarray) -> float:
    return stature(part_lengths(joints))


def pose_of(joints: np.ndarray) -> np.ndarray:
    return body_pose(joints, pelvis_basis(joints), height_of(joints))


def model_of(joints: np.ndarray, place: np.ndarray) -> SimpleNamespace:
    """A model of a point that is at a place in the camera frame while the body stands so."""
    bases = part_bases(joints, pelvis_basis(joints))
    turned = np.tile(UNTURNED, (len(PARTS), 1))
    translations, turns = bases.from_camera(np.tile(place, (len(PARTS), 1)), turned)
    return SimpleNamespace(
        mapping=SimpleNamespace(
            convention=None,
            body_poses=pose_of(joints)[None],
            translations=translations[None] / height_of(joints),
            rotations=turns[None],
        ),
        viewpoints=SimpleNamespace(
            directions=np.concatenate((np.eye(3), -np.eye(3))), boundaries=np.zeros((6, 5, 3))
        ),
        shape=SimpleNamespace(mirror_normal=np.array([1.0, 0.0, 0.0])),
    )


def cascade() -> Cascade2012:
    poses = np.stack((pose_of(STANDING), pose_of(RAISED)))
    svm = PairwiseSvm(
        vectors=poses,
        coefficients=np.array([[1.0], [-1.0]]),
        offsets=np.zeros(1),
        gamma=200.0,
        sigmoids=np.array([[-5.0, 0.0]]),
    )
    learned = SimpleNamespace(body_poses=poses, svm=svm)
    models = [model_of(STANDING, PLACE), model_of(RAISED, PLACE + 0.5)]
    return Cascade2012(learned, models)


@pytest.mark.parametrize(
    ("joints", "number", "place"), [(STANDING, 0, PLACE), (RAISED, 1, PLACE + 0.5)]
)
def test_the_action_of_a_pose_is_recognised_with_its_object(
    joints: np.ndarray, number: int, place: np.ndarray
) -> None:
    running = cascade()
    for frame in range(5):
        answer = running.step(joints, frame * FRAME_NS, None, CAMERA)
    assert answer.known == number
    assert answer.probabilities.sum() == pytest.approx(1.0)
    np.testing.assert_allclose(answer.estimate.translation, place, atol=1e-6)
    assert same_rotation(answer.estimate.rotation, UNTURNED, tolerance=1e-6)
    pixel = CAMERA.project(place)
    np.testing.assert_allclose(answer.box, [*pixel, *pixel], atol=30.0)


def test_without_a_body_the_object_is_lost_and_the_probabilities_stand() -> None:
    running = cascade()
    before = running.step(STANDING, 0)
    after = running.step(None, FRAME_NS)
    assert (after.known, after.estimate.state) == (None, "lost")
    np.testing.assert_array_equal(after.probabilities, before.probabilities)


def test_after_a_gap_the_particles_are_drawn_by_the_pose_alone() -> None:
    running = cascade()
    for frame in range(5):
        running.step(STANDING, frame * FRAME_NS)
    at_once = running.step(RAISED, 5 * FRAME_NS)
    running.restart()
    for frame in range(5):
        running.step(STANDING, frame * FRAME_NS)
    after_a_gap = running.step(RAISED, 5 * FRAME_NS + 10**9)
    assert after_a_gap.probabilities[1] == pytest.approx(1.0)
    assert at_once.probabilities[1] < 1.0
