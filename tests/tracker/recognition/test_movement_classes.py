"""How a movement speaks against each action by itself."""

from dataclasses import replace

import numpy as np
from inhand_tracker.recognition.movement_classes import MovementClasses
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION as USUAL

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
    np.testing.assert_allclose(doubts, [0.0, -USUAL.doubt_with_image * np.log(1.5), 0.0])


def test_without_an_image_doubts_weigh_more_and_none_is_likelier() -> None:
    doubts = CLASSES.doubts(np.array([[1.0, 0.0]]), seeing=False)[0]
    np.testing.assert_allclose(
        doubts, [0.0, -USUAL.doubt_without_image * np.log(1.5), USUAL.caution_without_image]
    )
    assert USUAL.doubt_without_image > USUAL.doubt_with_image


def test_evidence_is_what_the_likely_gaussians_say_with_some_caution() -> None:
    says = np.array([[2.0, 0.5, 0.5], [0.5, 2.0, 0.5], [0.25, 0.25, 2.5]])
    classes = replace(CLASSES, says=says)
    shares, distances = classes.gaussians(np.array([[1.0, 0.0], [10.0, 3.0]]))
    weights = np.exp(-0.5 * np.array([1.0, 9.0, 81.0]))
    np.testing.assert_allclose(shares[0], weights / weights.sum())
    np.testing.assert_allclose(distances[:, 0], [1.0, 3.0])
    evidence = classes.evidence(np.array([[1.0, 0.0]]))[0]
    expected = np.log(shares[0] @ says) + np.array([0.0, 0.0, USUAL.caution])
    np.testing.assert_allclose(evidence, expected)


def test_a_strange_movement_speaks_against_every_action() -> None:
    strange = np.array([[100.0 * np.e + 10.0, 0.0]])
    near = CLASSES.evidence(np.array([[10.0, 0.0]]))
    np.testing.assert_allclose(
        (CLASSES.evidence(strange) - near)[0], [-USUAL.strangeness, -USUAL.strangeness, 0.0]
    )


def test_what_lies_outside_of_the_centres_span_is_squared_distance() -> None:
    classes = replace(CLASSES, directions=np.array([[1.0], [0.0]]), centres=CLASSES.centres[:, :1])
    inside, rest = classes.project(np.array([[2.0, 3.0]]))
    np.testing.assert_allclose(inside, [[2.0]])
    np.testing.assert_allclose(rest, [9.0])
