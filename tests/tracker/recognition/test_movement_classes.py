"""How a movement speaks against each action by itself."""

import numpy as np
from inhand_tracker.recognition.movement_classes import (
    DOUBT,
    SEEN_DOUBT,
    UNSEEN_CAUTION,
    MovementClasses,
)

CLASSES = MovementClasses(
    means=np.zeros(2),
    whitening=np.eye(2),
    directions=np.eye(2),
    centres=np.array([[0.0, 0.0], [4.0, 0.0], [10.0, 0.0]]),
    log_shares=np.log(np.full(3, 1.0 / 3.0)),
    says=np.ones((3, 3)),
    limits=np.full(2, 100.0),
    reaches=np.array([1.0, 2.0]),
    owners=np.array([0, 1, 2]),
)
"""Two actions at 0 and 4, and using nothing at 10."""


def test_a_movement_is_as_far_from_an_action_as_from_its_own_nearest_centre() -> None:
    np.testing.assert_allclose(
        CLASSES.apart(np.array([[1.0, 0.0], [10.0, 0.0]])), [[1, 3], [10, 6]]
    )


def test_within_its_reach_an_action_is_not_doubted() -> None:
    doubts = CLASSES.doubts(np.array([[1.0, 0.0]]), seeing=True)[0]
    np.testing.assert_allclose(doubts, [0.0, -SEEN_DOUBT * np.log(1.5), 0.0])


def test_without_an_image_doubts_weigh_more_and_none_is_likelier() -> None:
    doubts = CLASSES.doubts(np.array([[1.0, 0.0]]), seeing=False)[0]
    np.testing.assert_allclose(doubts, [0.0, -DOUBT * np.log(1.5), UNSEEN_CAUTION])
    assert DOUBT > SEEN_DOUBT
