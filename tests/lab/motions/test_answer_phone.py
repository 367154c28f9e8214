"""answerPhone: the phone lies on an ear, is looked at in between, and may change hands."""

import numpy as np
import pytest
from inhand_lab.geometry.transforms import Transform
from inhand_lab.motions.performance import ContactKind
from performers import FRAME_RATE, depth_in_head, object_points, performed

PARTICIPANTS = range(10)
SCREEN = np.array([0.0, 1.0, 0.0])


def head_from_phone(participant: int) -> Transform:
    _, performance, body = performed("answerPhone", participant)
    return body.from_head.inverse() @ performance.world_from_object


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_the_screen_lies_on_the_ear_while_talking(participant: int) -> None:
    person, performance, body = performed("answerPhone", participant)
    points = object_points("answerPhone", performance.world_from_object)
    close = depth_in_head(person, body, points).max(axis=1) > -0.03
    assert close.sum() > FRAME_RATE
    relative = head_from_phone(participant)
    side = np.sign(relative.translation[close, 0])
    assert (relative.rotation @ SCREEN)[close, 0] @ side / close.sum() < -0.8
    ear_height = 0.6 * person.proportions.head_half_height
    assert np.abs(relative.translation[close, 2]).mean() < ear_height


def test_some_change_ears_and_both_hands_hold_the_phone_meanwhile() -> None:
    changed = []
    for participant in PARTICIPANTS:
        _, performance, _ = performed("answerPhone", participant)
        left = performance.contact == ContactKind.LEFT_HAND
        if left.any():
            changed.append(participant)
            assert (performance.contact == ContactKind.BOTH_HANDS).any()
            assert head_from_phone(participant).translation[left, 0].min() < -0.07
    assert 0 < len(changed) < len(PARTICIPANTS)
