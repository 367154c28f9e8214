"""putOnShoe: the shoe passes from the floor to the hand, to the foot, and back."""

import numpy as np
import pytest
from inhand_lab.motions.performance import ContactKind
from inhand_lab.people.kinematics import BALL_HEIGHT
from inhand_schemas.joints import Joint
from performers import FRAME_RATE, performed

PARTICIPANTS = range(10)


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_a_worn_shoe_moves_with_its_foot(participant: int) -> None:
    _, performance, body = performed("putOnShoe", participant)
    worn = performance.contact == ContactKind.WORN
    assert worn.sum() > FRAME_RATE
    foot_from_shoe = (
        performance.posture.world_from_right_foot.inverse() @ performance.world_from_object
    )[worn]
    assert np.ptp(foot_from_shoe.translation, axis=0).max() < 1e-9
    assert np.ptp(foot_from_shoe.rotation, axis=0).max() < 1e-9
    ankle = body.joints[worn, Joint.ANKLE_RIGHT] - performance.world_from_object.translation[worn]
    assert np.linalg.norm(ankle, axis=1).max() < 0.10


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_the_foot_is_raised_to_the_shoe_and_its_toes_tap(participant: int) -> None:
    _, performance, body = performed("putOnShoe", participant)
    ball = body.joints[:, Joint.FOOT_RIGHT, 2] - BALL_HEIGHT
    heel = performance.posture.world_from_right_foot.translation[:, 2]
    assert ball.max() > 0.10
    tapping = (heel < 0.03) & (performance.contact == ContactKind.WORN)
    assert ball[tapping].max() > 0.02
    raised = ball[tapping] > 0.01
    assert np.count_nonzero(np.diff(raised.astype(int)) == 1) >= 2


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_the_wearer_sits_on_the_stool_and_bends_to_the_floor(participant: int) -> None:
    person, performance, body = performed("putOnShoe", participant)
    (stool,) = performance.furniture
    seat = stool.centre[2] + 0.5 * stool.size[2]
    hips = body.joints[:, [Joint.HIP_LEFT, Joint.HIP_RIGHT], 2]
    assert np.ptp(hips) < 0.02
    assert 0.0 < hips.mean() - seat < 0.06 * person.height
    hand = body.joints[:, Joint.HAND_RIGHT, 2]
    assert hand.min() < 0.25
    assert hand[0] > 0.35
