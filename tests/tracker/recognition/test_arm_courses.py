"""Two movements of an arm that were taught, and how those are judged that are shown."""

import numpy as np
import pytest
from arm_paths import (
    FLAP,
    HANGING,
    LIFT_AND_SWEEP,
    SWEEP_FROM_BEHIND,
    Path,
    TimedPoses,
    arm_pose,
    arm_poses,
)
from inhand_tracker.recognition.arm_courses import ArmCourses, CourseFollower
from inhand_tracker.recognition.arm_movement import ArmReader
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION

ARMS = DEFAULT_RECOGNITION.arms
SWEEP, FLAPPING, UNTAUGHT = 0, 1, 2


def course(path: Path) -> np.ndarray:
    reader = ArmReader()
    return np.array([one for at, pose in arm_poses(path) for one in reader.read(at, pose)])


def follower() -> CourseFollower:
    """A follower of three actions, two of which somebody taught."""
    taught = [course(LIFT_AND_SWEEP), course(FLAP)]
    lengths = np.array([len(one) for one in taught])
    return CourseFollower(ArmCourses(np.concatenate(taught), lengths, np.array([0, 1])), 3)


def best_scores(poses: TimedPoses) -> np.ndarray:
    """Highest score (3,) that each action has at any time."""
    running = follower()
    scores = []
    for time_ns, pose in poses:
        running.add(time_ns, pose)
        scores.append(running.scores())
    return np.max(scores, axis=0)


def held(azimuth: float, elevation: float, seconds: float) -> TimedPoses:
    times = np.arange(0.0, seconds, 1.0 / 30.0)
    return [(round(at * 1e9), arm_pose(azimuth, elevation)) for at in times]


@pytest.mark.parametrize("tempo", [0.85, 1.0, 1.3])
def test_who_moves_as_was_taught_is_followed_faster_and_slower(tempo: float) -> None:
    sweep = best_scores(arm_poses(LIFT_AND_SWEEP, tempo=tempo))
    assert sweep[SWEEP] > ARMS.score > sweep[FLAPPING]
    flap = best_scores(arm_poses(FLAP, tempo=tempo))
    assert flap[FLAPPING] > ARMS.score > flap[SWEEP]


def test_the_same_way_backwards_is_not_the_action() -> None:
    assert best_scores(arm_poses(SWEEP_FROM_BEHIND))[SWEEP] < 0.5 * ARMS.score


@pytest.mark.parametrize("pose", [HANGING, (0.0, 30.0), (80.0, 30.0)])
def test_who_stands_still_is_doing_nothing_even_in_a_taught_pose(pose: Path) -> None:
    assert best_scores(held(*pose, seconds=8.0)).max() < ARMS.score


def test_of_an_action_that_nobody_taught_nothing_is_said() -> None:
    assert best_scores(arm_poses(FLAP))[UNTAUGHT] == 0.0


def test_evidence_is_bounded_and_speaks_for_what_is_made() -> None:
    running = follower()
    assert running.evidence() == pytest.approx([-ARMS.most_against] * 3 + [0.0])
    for time_ns, pose in arm_poses(LIFT_AND_SWEEP):
        running.add(time_ns, pose)
    evidence = running.evidence()
    assert 0.0 < evidence[SWEEP] <= ARMS.most_for
    assert evidence[FLAPPING] == -ARMS.most_against
    assert evidence[-1] == 0.0


def test_it_does_not_matter_how_often_evidence_is_asked_for() -> None:
    often, once = follower(), follower()
    for time_ns, pose in arm_poses(LIFT_AND_SWEEP):
        often.add(time_ns, pose)
        often.evidence()
        once.add(time_ns, pose)
    np.testing.assert_array_equal(often.scores(), once.scores())


def test_who_comes_next_starts_without_a_score() -> None:
    running = follower()
    for time_ns, pose in arm_poses(LIFT_AND_SWEEP):
        running.add(time_ns, pose)
    running.evidence()
    running.restart()
    assert running.scores().max() == 0.0


def test_without_any_course_every_action_is_doubted() -> None:
    nothing = ArmCourses(np.empty((0, 18)), np.empty(0, np.int64), np.empty(0, np.int64))
    running = CourseFollower(nothing, 2)
    running.add(0, arm_pose(*HANGING))
    assert running.evidence() == pytest.approx([-ARMS.most_against] * 2 + [0.0])
