"""People who walk about and turn while they use a thing."""

import numpy as np
import pytest
from inhand_lab.motions.performance import ContactKind
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.world.enactment import Enactment
from inhand_lab.world.rigs import simulate_rig, simulate_rig_cast
from inhand_lab.world.roaming import ROAMING_INTERACTIONS
from inhand_lab.world.simulation import Casting, enact
from inhand_schemas.joints import PARENTS, Joint

FRAMES, RATE = 360, 30.0
FEET = [Joint.FOOT_LEFT, Joint.FOOT_RIGHT]


def both(interaction: str, participant: int = 0) -> tuple[Enactment, Enactment]:
    """The performance while walking about, and on the spot."""
    there = Casting(interaction, participant, seed=3, roaming=True)
    return enact(there, FRAMES, RATE), enact(Casting(interaction, participant, 3), FRAMES, RATE)


def turns(enacted: Enactment) -> np.ndarray:
    across = enacted.body.joints[:, Joint.HIP_RIGHT] - enacted.body.joints[:, Joint.HIP_LEFT]
    return np.unwrap(np.arctan2(across[:, 1], across[:, 0]))


@pytest.mark.parametrize("interaction", ROAMING_INTERACTIONS)
def test_the_object_is_in_the_hand_as_on_the_spot_and_rests_where_it_did(
    interaction: str,
) -> None:
    roaming, staying = both(interaction)
    assert np.array_equal(roaming.contact, staying.contact)
    held = roaming.contact == ContactKind.RIGHT_HAND
    hands = [
        (one.body.from_right_hand.inverse() @ one.world_from_object)[held]
        for one in (roaming, staying)
    ]
    assert hands[0].translation == pytest.approx(hands[1].translation, abs=0.01)
    resting = roaming.contact == ContactKind.RESTING
    places = [one.world_from_object.translation[resting] for one in (roaming, staying)]
    assert places[0] == pytest.approx(places[1], abs=1e-9)


def test_people_turn_by_up_to_half_a_turn_and_go_up_to_a_metre_away_and_come_back() -> None:
    most = []
    for interaction in ROAMING_INTERACTIONS:
        roaming, staying = both(interaction)
        turned = np.abs(turns(roaming) - turns(staying))
        gone = roaming.body.joints[:, 0] - staying.body.joints[:, 0]
        assert np.linalg.norm(gone[:, :2], axis=1).max() <= 1.0
        assert np.abs(gone[[0, -1]]).max() < 1e-9
        assert turned[[0, -1]].max() < 1e-9
        assert turned.max() <= np.pi
        most.append((turned.max(), np.linalg.norm(gone, axis=1).max()))
    assert np.median(most, axis=0)[0] > np.radians(75.0)
    assert np.median(most, axis=0)[1] > 0.4


def test_standing_feet_do_not_slide_and_bones_keep_their_lengths() -> None:
    for interaction in ("drinkFromMug", "sweepFloor", "hitTennisBall"):
        roaming, staying = both(interaction)
        joints = roaming.body.joints
        bones = np.linalg.norm(joints - joints[:, PARENTS], axis=2)
        expected = np.linalg.norm(staying.body.joints - staying.body.joints[:, PARENTS], axis=2)
        assert bones[:, 12:] == pytest.approx(expected[:, 12:], abs=2e-3)
        if interaction == "drinkFromMug":
            feet = joints[:, FEET]
            speed = np.linalg.norm(np.diff(feet, axis=0), axis=2) * RATE
            standing = np.maximum(feet[1:, :, 2], feet[:-1, :, 2]) < 0.0201
            assert speed[standing].max() < 0.06
            assert standing.mean() > 0.4


def test_left_handed_people_walk_about_with_the_left_hand() -> None:
    left = next(p for p in range(40) if Casting("", p, 3).person().handedness == "left")
    roaming, staying = both("drinkFromMug", left)
    held = roaming.contact == ContactKind.LEFT_HAND
    assert held.mean() > 0.5
    hands = [
        (one.body.from_left_hand.inverse() @ one.world_from_object)[held]
        for one in (roaming, staying)
    ]
    assert hands[0].translation == pytest.approx(hands[1].translation, abs=0.01)


def test_who_walks_about_stays_in_the_image_of_every_camera() -> None:
    for interaction in ("answerPhone", "sweepFloor"):
        rig = simulate_rig(interaction, 0, 1, roaming=True)
        for seen in rig.cameras:
            points = seen.true_joints_in_camera
            lens = seen.intrinsics
            pixels = points[..., :2] / points[..., 2:] * lens.fx + (lens.cx, lens.cy)
            outside = (pixels < 0.0) | (pixels > (lens.width, lens.height))
            assert outside.any(axis=2).mean() < 0.01


def test_nobody_walks_about_with_what_furniture_is_needed_for_or_who_may_sit() -> None:
    with pytest.raises(ValueError, match="nobody walks about in 'pourCream'"):
        simulate_rig("pourCream", 0, 0, roaming=True)
    with pytest.raises(ValueError, match="only usual people"):
        simulate_rig_cast(
            Casting("drinkFromMug", 0, 0, people="varied", roaming=True), 30, KINECT, 2
        )
