"""Which courses of arms are kept of people's recordings."""

import numpy as np
from inhand_lab.training.arm_course_training import arms_in_use, learn_courses
from inhand_lab.training.movement_gaussians import MovementSequence
from inhand_lab.training.parameters import DEFAULT_TRAINING
from inhand_tracker.recognition.arm_movement import WRISTS
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION

HANGING = np.array(DEFAULT_RECOGNITION.arms.hanging_wrist)
RAISED = np.array([-0.45, 0.03, 0.3])
HANGS, WORKS = 6, 9


def arms(number: float = 0.0) -> np.ndarray:
    """Both arms hang, one works, both hang; a last number tells recordings apart."""
    some = np.zeros((2 * HANGS + WORKS, 18))
    wrists = some[:, WRISTS].reshape(-1, 2, 3)
    wrists[:] = HANGING, HANGING * [-1.0, 1.0, 1.0]
    wrists[HANGS : HANGS + WORKS, 0] = RAISED
    some[:, WRISTS] = wrists.reshape(-1, 6)
    some[:, -1] = number
    return some


def recording(action: int, participant: str, number: float) -> MovementSequence:
    return MovementSequence(action, participant, np.zeros((1, 2)), np.zeros(1), arms(number))


def test_how_arms_hang_at_first_and_at_last_is_left_out() -> None:
    used = arms_in_use(arms())
    assert len(used) == WORKS + 2
    np.testing.assert_array_equal(used[1:-1, :3], np.tile(RAISED, (WORKS, 1)))
    assert len(arms_in_use(arms()[:HANGS])) == 0


def test_all_people_teach_as_far_as_there_is_room() -> None:
    many = [recording(0, "a", number) for number in range(DEFAULT_TRAINING.courses)]
    few = [recording(0, "b", 100.0), recording(1, "b", 200.0)]
    courses = learn_courses([*many, *few, recording(2, "idle", 300.0)], 2)
    assert np.bincount(courses.owners).tolist() == [DEFAULT_TRAINING.courses, 1]
    assert courses.lengths.sum() == len(courses.observations)
    numbers = set(courses.observations[:, -1])
    assert {100.0, 200.0} < numbers
    assert 300.0 not in numbers
