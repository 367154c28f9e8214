"""A hand that has nothing to do while the other uses a thing."""

import numpy as np
from inhand_lab.geometry.transforms import Transform
from inhand_lab.motions.performance import ContactKind
from inhand_lab.people.person import People
from performers import perform


def left_hand_and_mug(people: People, participant: int) -> tuple[Transform, Transform]:
    """The left hand from the chest (T) and the mug from it (T), while the mug is carried."""
    _, performance, body = perform("drinkFromMug", participant, 3, 15.0, people)
    carried = performance.contact == ContactKind.RIGHT_HAND
    from_chest = body.from_chest[carried].inverse()
    return (
        from_chest @ body.from_left_hand[carried],
        from_chest @ performance.world_from_object[carried],
    )


def risen(people: People) -> list[float]:
    """Height to which the left hand rises, from the shoulder centre, metres, in 16 performances."""
    return [left_hand_and_mug(people, n)[0].translation[:, 2].max() for n in range(16)]


def test_a_varied_persons_other_hand_gestures_while_a_thing_is_used_and_a_usual_ones_hangs() -> (
    None
):
    assert max(risen("usual")) < -0.45
    up = np.array(risen("varied"))
    assert 3 < np.count_nonzero(up > -0.3) < 13


def test_a_gesture_keeps_away_from_the_thing() -> None:
    for participant in range(16):
        hand, mug = left_hand_and_mug("varied", participant)
        apart = np.linalg.norm(hand.translation - mug.translation, axis=1)
        assert apart.min() > 0.15
