"""Two simulated people who hand over a mug."""

import numpy as np
import pytest
from inhand_lab.sensing.skeleton_noise import MISSING, joints_behind
from inhand_lab.world.handover import GIVER, TAKER, HandoverSimulation, simulate_handover
from inhand_lab.world.simulation import Simulation, simulate
from inhand_schemas.joints import PARENTS, Joint


@pytest.fixture(scope="module")
def handover() -> HandoverSimulation:
    return simulate_handover(seed=1, cameras=4)


def hand_of(seen: Simulation, role: int) -> np.ndarray:
    """The mug (T, 3) in the right hand's frame of giver or taker."""
    body = seen.body_in_camera if role == GIVER else seen.others[0].body_in_camera
    return (body.from_right_hand.inverse() @ seen.camera_from_object).translation


def test_the_mug_is_in_the_givers_hand_and_then_in_the_takers_and_does_not_jump(
    handover: HandoverSimulation,
) -> None:
    for camera, seen in enumerate(handover.rig.cameras):
        holders = handover.holders[camera]
        assert set(holders.tolist()) == {GIVER, TAKER}
        assert np.all(np.diff(holders.astype(int)) >= 0)
        for role in (GIVER, TAKER):
            assert np.ptp(hand_of(seen, role)[holders == role], axis=0).max() < 2e-3
        steps = np.linalg.norm(np.diff(seen.translations, axis=0), axis=1)
        assert 30.0 * steps.max() < 1.5
        handed = int(np.argmax(holders == TAKER))
        assert 30.0 * steps[handed - 1] < 0.05


def test_both_walk_past_each_other_without_touching_and_keep_their_bones(
    handover: HandoverSimulation,
) -> None:
    seen = handover.rig.cameras[0]
    bodies = (seen.body_in_camera.joints, seen.others[0].body_in_camera.joints)
    trunks = [joints[:, Joint.SHOULDER_CENTER] for joints in bodies]
    assert np.linalg.norm(trunks[0] - trunks[1], axis=1).min() > 0.6
    # Before the first camera they change sides.
    across = trunks[0][:, 0] - trunks[1][:, 0]
    assert across[0] * across[-1] < 0.0
    for joints in bodies:
        legs = np.linalg.norm(joints - joints[:, PARENTS], axis=2)[:, 13:]
        assert np.ptp(legs, axis=0).max() < 2e-3


def test_who_is_hidden_is_not_followed_and_has_another_number_after_a_while(
    handover: HandoverSimulation,
) -> None:
    lost = 0
    for camera, seen in enumerate(handover.rig.cameras):
        numbers = handover.numbers[camera]
        for role, reading in ((GIVER, seen.reading), (TAKER, seen.others[0].reading)):
            missing = (reading.states == MISSING).all(axis=1)
            assert np.array_equal(numbers[:, role] < 0, missing)
            lost += int(missing.sum())
        both = (numbers >= 0).all(axis=1)
        assert both.mean() > 0.5
        assert (numbers[both, GIVER] != numbers[both, TAKER]).all()
        for frame in (0, 200, 400):
            people = handover.people(camera, frame)
            assert [one.id for one in people] == sorted(n for n in numbers[frame] if n >= 0)
            holder = handover.holder(camera, frame)
            assert holder is None or holder in {one.id for one in people}
    assert lost > 0


def test_joints_behind_somebody_are_hidden_and_those_before_them_are_not() -> None:
    seen = simulate("drinkFromMug", 0, 1, frames=2)
    body = seen.true_joints_in_camera
    centre = Joint.SHOULDER_CENTER
    assert joints_behind(seen.person, body, body * 1.4)[:, centre].all()
    assert not joints_behind(seen.person, body, body * 0.7).any()


def test_both_are_in_the_picture(handover: HandoverSimulation) -> None:
    seen = handover.rig.cameras[0]
    depth = seen.render(60).depth
    for joints in (seen.body_in_camera.joints[60], seen.others[0].body_in_camera.joints[60]):
        x, y, z = joints[Joint.SPINE]
        lens = seen.intrinsics
        there = depth[round(y / z * lens.fy + lens.cy), round(x / z * lens.fx + lens.cx)]
        assert 1e-3 * there == pytest.approx(z, abs=0.4)
