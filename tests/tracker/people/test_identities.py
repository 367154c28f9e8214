"""People keep their numbers by where they go and how they are built."""

import numpy as np
from inhand_schemas.messages import Person
from inhand_tracker.people.identities import Identities
from inhand_tracker.people.parameters import DEFAULT_PEOPLE
from people import FRAME_NS, STANDING

PATIENCE_NS = DEFAULT_PEOPLE.patience_ns


def at(x: float, camera_id: int, size: float = 1.0) -> Person:
    joints = STANDING * size + np.array([x, 0.0, 0.0])
    return Person(
        id=camera_id,
        joints=tuple(map(tuple, joints.tolist())),
        states=("tracked",) * 20,
        confidences=(1.0,) * 20,
    )


def test_a_camera_that_exchanges_two_ids_exchanges_no_numbers() -> None:
    identities = Identities()
    first = identities.assign([at(-1.0, 7), at(1.0, 8)], 0)
    assert [first[0].id, first[1].id] == [7, 8]
    second = identities.assign([at(1.0, 7), at(-1.0, 8)], FRAME_NS)
    assert [second[0].id, second[1].id] == [8, 7]


def test_two_who_come_out_from_behind_each_other_are_told_by_their_bones() -> None:
    identities = Identities()
    for frame in range(10):
        identities.assign([at(0.0, 1, 1.0), at(0.5, 2, 0.85)], frame * FRAME_NS)
    hidden = identities.assign([at(0.2, 1, 1.0)], 11 * FRAME_NS)
    assert list(hidden) == [0]
    back = identities.assign([at(0.3, 1, 0.85), at(0.25, 2, 1.0)], 16 * FRAME_NS)
    assert [back[0].id, back[1].id] == [2, 1]


def test_who_is_away_for_more_than_a_second_comes_back_as_somebody_else() -> None:
    identities = Identities()
    identities.assign([at(0.0, 1)], 0)
    assert list(identities.assign([at(0.0, 1)], PATIENCE_NS)) == [0]
    assert list(identities.assign([at(0.0, 1)], 3 * PATIENCE_NS)) == [1]


def test_nobody_jumps_across_the_room_and_a_clock_may_go_back() -> None:
    identities = Identities()
    identities.assign([at(0.0, 1)], 10 * FRAME_NS)
    assert list(identities.assign([at(3.0, 1)], 11 * FRAME_NS)) == [1]
    assert list(identities.assign([at(0.0, 1)], 0)) == [2]


def test_a_person_without_a_trunk_is_nobody_yet() -> None:
    hidden = at(0.0, 1)
    states = ("missing", *hidden.states[1:])
    person = Person(id=1, joints=hidden.joints, states=states, confidences=hidden.confidences)
    assert Identities().assign([person], 0) == {}
    assert list(Identities(needs_hips=False).assign([person], 0)) == [0]
