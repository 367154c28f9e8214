"""Skeletons of several people, from frame to frame, by a network that finds who it is told to."""

import numpy as np
import pytest
from inhand_capture.estimation.estimator import EstimationError, SkeletonEstimator
from inhand_schemas.joints import Joint
from inhand_schemas.messages import Skeletons
from inhand_schemas.topics import SKELETONS
from posed_person import INFO, ToldNetwork, depth_of, seen, standing

COLOUR = np.zeros((480, 640, 3), np.uint8)
FRAME_NS = 33_333_333


def test_people_keep_their_ids_when_a_network_names_them_in_another_order() -> None:
    left, right = standing(x=-0.6), standing(x=0.6)
    one, other = seen(left), seen(right)
    estimator = SkeletonEstimator(ToldNetwork([[one, other], [other, one], [other]]), INFO)
    depth = depth_of(left, right)
    ids = []
    for number in range(3):
        people = estimator.estimate(COLOUR, depth, number * FRAME_NS)
        ids.append({round(person.joints[Joint.HEAD][0], 1): person.id for person in people})
    assert ids == [{-0.6: 0, 0.6: 1}, {-0.6: 0, 0.6: 1}, {0.6: 1}]


def test_who_comes_back_soon_is_the_same_and_who_comes_late_is_somebody_new() -> None:
    truth = standing()
    depth = depth_of(truth)
    script = [[seen(truth)], [], [seen(truth)], [seen(truth)]]
    estimator = SkeletonEstimator(ToldNetwork(script), INFO)
    ids = [
        [person.id for person in estimator.estimate(COLOUR, depth, time_ns)]
        for time_ns in (0, FRAME_NS, 1_000_000_000, 4_000_000_000)
    ]
    assert ids == [[0], [], [0], [1]]


def test_a_clock_that_goes_back_begins_anew_and_does_not_fail() -> None:
    truth = standing()
    estimator = SkeletonEstimator(ToldNetwork([[seen(truth)]]), INFO)
    depth = depth_of(truth)
    ids = [estimator.estimate(COLOUR, depth, t)[0].id for t in (10**9, 5, 5)]
    assert ids[0] == 0
    assert len(ids) == 3


def test_ten_people_and_nobody_are_messages() -> None:
    crowd = [standing(x=0.35 * number - 1.6, z=3.0) for number in range(10)]
    estimator = SkeletonEstimator(ToldNetwork([[seen(one) for one in crowd], []]), INFO)
    depth = depth_of(*crowd)
    many, none = (estimator.estimate(COLOUR, depth, n * FRAME_NS) for n in range(2))
    assert [person.id for person in many] == list(range(10))
    assert none == ()
    message = Skeletons(sequence=1, time_ns=1, people=many)
    assert SKELETONS.decode(SKELETONS.encode(message)) == message


def test_states_and_confidences_say_what_was_measured() -> None:
    truth = standing()
    depth = depth_of(truth)
    estimator = SkeletonEstimator(ToldNetwork([[seen(truth)]]), INFO)
    (person,) = estimator.estimate(COLOUR, depth, 0)
    assert person.states[Joint.HEAD] == "tracked"
    assert person.confidences[Joint.HEAD] == 1.0
    assert person.states[Joint.SPINE] == "inferred"
    assert person.confidences[Joint.SPINE] == 0.5


@pytest.mark.parametrize(
    ("colour", "depth", "lacking"),
    [(None, np.zeros((4, 4), np.uint16), "colour"), (COLOUR, None, "depth")],
)
def test_without_colour_or_depth_there_is_one_line(colour, depth, lacking: str) -> None:  # type: ignore[no-untyped-def]
    estimator = SkeletonEstimator(ToldNetwork([[]]), INFO)
    with pytest.raises(EstimationError, match=f"no skeletons without {lacking}: the camera gives"):
        estimator.estimate(colour, depth, 0)
