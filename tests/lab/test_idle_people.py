"""People who use nothing stand and walk as people do."""

import numpy as np
import pytest
from inhand_lab.idle_people import IDLENESS, watch_idle
from inhand_lab.joints import PARENTS, Joint


@pytest.mark.parametrize("idleness", IDLENESS)
def test_the_same_seed_shows_the_same_person_and_another_seed_another(idleness: str) -> None:
    one, same = (watch_idle(idleness, 3, 1, frames=60) for _ in range(2))
    np.testing.assert_array_equal(one.joints, same.joints)
    assert not np.allclose(one.joints, watch_idle(idleness, 3, 2, frames=60).joints)


@pytest.mark.parametrize("idleness", IDLENESS)
def test_trunks_keep_their_lengths_and_stay_before_the_camera(idleness: str) -> None:
    joints = watch_idle(idleness, 0, 4, frames=300).joints
    for joint in (Joint.SPINE, Joint.SHOULDER_CENTER, Joint.HEAD):
        lengths = np.linalg.norm(joints[:, joint] - joints[:, PARENTS[joint]], axis=1)
        assert np.nanstd(lengths) < 0.05
    hips = joints[:, Joint.HIP_CENTER]
    assert np.nanmin(hips[:, 2]) > 1.5
    assert np.nanmax(np.abs(hips[:, 0])) < 2.0


def test_who_walks_lifts_one_foot_after_the_other_and_who_stands_none() -> None:
    def lifted(idleness: str) -> np.ndarray:
        joints = watch_idle(idleness, 1, 5, frames=300).joints
        return joints[:, Joint.ANKLE_LEFT, 1] - joints[:, Joint.ANKLE_RIGHT, 1]

    walking, standing = lifted("walkOnSpot"), lifted("stand")
    assert np.nanstd(walking) > 3.0 * np.nanstd(standing)
    signs = np.sign(walking[np.abs(walking - np.nanmean(walking)) > 0.04])
    assert np.count_nonzero(np.diff(signs)) > 8


def test_only_gestures_and_fidgets_bring_hands_above_the_chest() -> None:
    def highest(idleness: str) -> float:
        joints = np.concatenate([watch_idle(idleness, n, 6).joints for n in range(3)])
        hands = joints[:, [Joint.HAND_LEFT, Joint.HAND_RIGHT], 1]
        return float(np.nanmax(joints[:, [Joint.SHOULDER_CENTER], 1] - hands))

    assert highest("stand") < 0.0
    assert highest("gesture") > 0.0
    assert highest("fidget") > 0.0
