"""Movement and looks at images together, on two actions that one number tells apart."""

from dataclasses import replace

import numpy as np
import pytest
from arm_paths import LIFT_AND_SWEEP, arm_poses
from inhand_tracker.body.reader import Body
from inhand_tracker.body.skeleton import Bases
from inhand_tracker.recognition.arm_courses import ArmCourses
from inhand_tracker.recognition.arm_movement import ArmReader
from inhand_tracker.recognition.movement_classes import MovementClasses
from inhand_tracker.recognition.movement_window import MovementWindow
from inhand_tracker.recognition.parameters import RecognitionParameters
from inhand_tracker.recognition.recogniser import MovementRecogniser
from inhand_tracker.recognition.recognition import recognised_action
from people import FRAME_NS

FIRST, SECOND = (np.full(60, level) for level in (0.0, 1.0))
"""The body poses of two actions."""


def features_of(pose: np.ndarray) -> np.ndarray:
    window = MovementWindow()
    window.add(0, pose)
    return window.features()


def classes() -> MovementClasses:
    """Two actions, and nothing in use half-way: only the way between the actions counts."""
    first, second = features_of(FIRST), features_of(SECOND)
    way = second - first
    return MovementClasses(
        means=first,
        whitening=6.0 * way[:, None] / (way @ way),
        directions=np.eye(1),
        centres=np.array([[0.0], [6.0], [3.0]]),
        log_shares=np.log(np.full(3, 1.0 / 3.0)),
        says=np.array([[2.5, 0.2, 0.3], [0.2, 2.5, 0.3], [0.3, 0.3, 2.4]]),
        limits=np.full(2, 100.0),
        reaches=np.full(2, 1.0),
        owners=np.array([0, 1, 2]),
    )


CLASSES = classes()


def body(pose: np.ndarray) -> Body:
    return Body(np.zeros((20, 3)), pose, Bases(np.zeros(3), np.zeros(4)), 1.7)


def run(
    pose: np.ndarray, seen: list[float] | None, frames: int = 60, looks_at_once: float = 2.5
) -> np.ndarray:
    parameters = RecognitionParameters(looks_at_once=looks_at_once, caution_without_image=0.0)
    recogniser = MovementRecogniser(CLASSES, 0.4, parameters)
    evidence = None if seen is None else np.array(seen)
    for frame in range(frames):
        probabilities = recogniser.step(frame * FRAME_NS, body(pose), evidence)
    return probabilities


@pytest.mark.parametrize(("pose", "number"), [(FIRST, 0), (SECOND, 1), (0.5 * FIRST, 0)])
def test_a_movement_that_lasts_is_recognised(pose: np.ndarray, number: int) -> None:
    probabilities = run(pose, [0.0, 0.0, 0.0])
    assert probabilities.sum() == pytest.approx(1.0)
    assert probabilities[number] == probabilities[:2].max()
    assert probabilities[number] > 5.0 * probabilities[1 - number]


def test_a_look_counts_at_once_and_over_time() -> None:
    one = run(FIRST, [0.0, 3.0, 0.0], frames=1)
    later = run(FIRST, [0.0, 3.0, 0.0], frames=1, looks_at_once=0.0)
    assert one[1] / one[0] == pytest.approx(np.exp(2.5 * 3.0) * later[1] / later[0])
    against = run(FIRST, [-6.0, 0.0, 0.0])
    assert against[0] < 0.01 < 0.5 < run(FIRST, [3.0, 0.0, 0.0])[0]


def test_what_looks_like_an_object_for_ever_is_none_while_nobody_moves_as_with_it() -> None:
    recogniser = MovementRecogniser(CLASSES, 0.1)
    looks = np.array([0.0, 3.0, 0.0])
    with_nothing, as_with_it = body(0.5 * SECOND), body(SECOND)
    for frame in range(300):
        idle = recogniser.step(frame * FRAME_NS, with_nothing, looks)
    for frame in range(300, 330):
        used = recogniser.step(frame * FRAME_NS, as_with_it, looks)
    assert recognised_action(idle[:-1]) is None
    assert recognised_action(used[:-1]) == 1


def test_who_comes_next_starts_without_a_history() -> None:
    recogniser = MovementRecogniser(CLASSES, 0.4)
    first = recogniser.step(0, body(FIRST)).copy()
    for frame in range(1, 20):
        recogniser.step(frame * FRAME_NS, body(SECOND))
    recogniser.restart()
    np.testing.assert_array_equal(recogniser.step(0, body(FIRST)), first)


def strange_classes() -> tuple[MovementClasses, list[tuple[int, np.ndarray]]]:
    """Classes of which every body is far, with one course of action 1, and the poses of it."""
    poses = arm_poses(LIFT_AND_SWEEP)
    reader = ArmReader()
    taught = np.array([one for time_ns, pose in poses for one in reader.read(time_ns, pose)])
    arms = ArmCourses(taught, np.array([len(taught)]), np.array([1]))
    return replace(CLASSES, limits=np.full(2, 1e-9), arms=arms), poses


def test_where_a_body_is_unlike_all_that_were_learned_the_arms_decide() -> None:
    strange, poses = strange_classes()
    known = []
    for classes in (
        replace(strange, arms=None),
        strange,
        replace(strange, limits=CLASSES.limits),
    ):
        recogniser = MovementRecogniser(classes, 0.4)
        for time_ns, pose in poses:
            probabilities = recogniser.step(time_ns, body(pose))
        known.append(recognised_action(probabilities[:-1]))
    assert known[:2] == [None, 1]
    assert known[2] != 1


def test_a_body_unlike_all_that_were_learned_whose_arms_do_nothing_needs_a_clear_look() -> None:
    strange, poses = strange_classes()

    def last(poses: list[tuple[int, np.ndarray]], look: float) -> int | None:
        recogniser = MovementRecogniser(strange, 0.1)
        for time_ns, pose in poses:
            probabilities = recogniser.step(time_ns, body(pose), np.array([0.0, look, 0.0]))
        return recognised_action(probabilities[:-1])

    still = [(frame * FRAME_NS, poses[0][1]) for frame in range(300)]
    assert last(still, 1.3) is None
    assert last(still, 3.5) == 1
    assert last(poses, 1.5) == 1
