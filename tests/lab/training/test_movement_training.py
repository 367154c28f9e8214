"""Training of movement classes on two actions and idle people who differ in two numbers."""

import numpy as np
import pytest
from inhand_lab.training.movement_gaussians import MovementSequence
from inhand_lab.training.movement_training import train_movements
from inhand_lab.training.parameters import DEFAULT_TRAINING
from inhand_tracker.recognition.movement_classes import MovementClasses

ACTIONS = 2
MIDDLES = np.array([[0.0, 0.0], [8.0, 0.0], [4.0, 9.0]])
FRAMES = 70


def features(action: int, random: np.random.Generator) -> np.ndarray:
    """Features of an action, or of idle people, and a third number that says nothing."""
    known = MIDDLES[action] + random.normal(size=(FRAMES, 2))
    return np.column_stack((known, random.normal(size=FRAMES)))


def sequence(action: int, participant: str, of_body: np.ndarray) -> MovementSequence:
    """A recording in which arms are up."""
    times_ns = np.arange(FRAMES) * 33_000_000
    return MovementSequence(action, participant, of_body, times_ns, np.zeros((FRAMES // 2, 18)))


@pytest.fixture(scope="module")
def learned() -> tuple[MovementClasses, float]:
    random = np.random.default_rng(5)
    sequences = [
        sequence(action, participant, features(action, random))
        for participant in "abc"
        for action in range(ACTIONS + 1)
    ]
    return train_movements(sequences, ACTIONS)


def test_every_movement_speaks_for_its_own_class(learned: tuple[MovementClasses, float]) -> None:
    classes, _ = learned
    random = np.random.default_rng(6)
    for action in range(ACTIONS + 1):
        likeliest = classes.evidence(features(action, random)).argmax(axis=1)
        assert (likeliest == action).mean() > 0.8


def test_limits_and_reaches_hold_the_shares_of_people_they_are_named_by(
    learned: tuple[MovementClasses, float],
) -> None:
    classes, _ = learned
    unseen = features(0, np.random.default_rng(7))
    _, distances = classes.gaussians(unseen)
    assert (distances <= classes.limits).all(axis=1).mean() > 0.9
    within = (classes.apart(unseen)[:, 0] <= classes.reaches[0]).mean()
    assert within == pytest.approx(DEFAULT_TRAINING.within_reach_share, abs=0.2)


def test_actions_have_few_gaussians_and_idle_people_many(
    learned: tuple[MovementClasses, float],
) -> None:
    classes, temper = learned
    counts = np.bincount(classes.owners)
    assert list(counts) == [DEFAULT_TRAINING.action_gaussians] * ACTIONS + [
        DEFAULT_TRAINING.idle_gaussians
    ]
    assert temper in DEFAULT_TRAINING.tempers


def test_the_same_sequences_teach_the_same() -> None:
    random = np.random.default_rng(8)
    sequences = [
        sequence(action, participant, features(action, random))
        for participant in "ab"
        for action in range(ACTIONS + 1)
    ]
    one, other = (train_movements(sequences, ACTIONS)[0] for _ in range(2))
    np.testing.assert_array_equal(one.says, other.says)


def test_who_is_unlike_all_others_teaches_the_arms_alone(
    learned: tuple[MovementClasses, float],
) -> None:
    random = np.random.default_rng(5)
    people = [
        sequence(action, participant, features(action, random))
        for participant in "abc"
        for action in range(ACTIONS + 1)
    ]
    elsewhere = np.array([0.0, 0.0, 60.0])
    stranger = [
        sequence(action, "s", features(action, random) + elsewhere) for action in range(ACTIONS)
    ]
    classes, _ = train_movements([*people, *stranger], ACTIONS)
    np.testing.assert_array_equal(classes.limits, learned[0].limits)
    np.testing.assert_array_equal(classes.centres, learned[0].centres)
    unlike = features(0, np.random.default_rng(9)) + elsewhere
    assert classes.at_home(features(0, np.random.default_rng(9))).mean() > 0.95
    assert classes.at_home(unlike).max() == 0.0
    arms, alone = classes.arms, learned[0].arms
    assert arms is not None
    assert alone is not None
    assert list(np.bincount(alone.owners)) == [3] * ACTIONS
    assert list(np.bincount(arms.owners)) == [4] * ACTIONS
