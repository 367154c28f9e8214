"""The comparison of real people's postures with simulated ones."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_lab.realism.posture_angles import (
    CONVENTION,
    LIMBS,
    POSTURE_ANGLES,
    ObservedPostures,
    share_within,
    spread_of,
)
from inhand_lab.realism.posture_comparison import (
    compare_postures,
    compare_variety,
    recorded_sources,
)
from inhand_schemas.joints import Joint
from inhand_tracker.body.skeleton import mirror_joints
from inhand_tracker.geometry.arrays import Array
from real_data import DATA, needs_real_data
from waving import STANDING

ANGLES = {one.name: one for one in POSTURE_ANGLES}


def standing(frames: int = 10) -> Array:
    return np.repeat(STANDING[None], frames, axis=0)


def recorded(joints: Array, who: str = "a", handedness: str = "right") -> ObservedPostures:
    return ObservedPostures.of(who, "liftWeights", joints, handedness)


def test_every_joint_is_the_corner_or_the_end_of_an_angle_and_limbs_know_no_middle_joint() -> None:
    joints = {
        group: {
            joint
            for angle in POSTURE_ANGLES
            if angle.group == group
            for place in (*angle.one, *angle.other)
            for joint in place
        }
        for group in (LIMBS, CONVENTION)
    }
    assert joints[LIMBS] | joints[CONVENTION] == set(Joint)
    assert not joints[LIMBS] & {Joint.HIP_CENTER, Joint.SPINE, Joint.SHOULDER_CENTER}
    assert not any(joint.name.startswith(("HAND", "FOOT")) for joint in joints[LIMBS])


def test_an_arm_that_is_bent_at_a_right_angle_has_that_angle_wherever_the_body_is_turned() -> None:
    joints = standing()
    upper = joints[:, Joint.ELBOW_RIGHT] - joints[:, Joint.SHOULDER_RIGHT]
    aside = np.cross(upper, [0.0, 0.0, 1.0])
    joints[:, Joint.WRIST_RIGHT] = joints[:, Joint.ELBOW_RIGHT] + aside
    turn, _ = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))
    for one in (joints, joints @ turn.T + 1.0):
        np.testing.assert_allclose(ANGLES["right elbow, bend"].of(one), 90.0, atol=1e-6)


def test_left_handed_people_are_compared_by_the_hand_that_they_use() -> None:
    joints = standing()
    joints[:, Joint.WRIST_RIGHT] = joints[:, Joint.SHOULDER_RIGHT] + (0.1, 0.0, 0.0)
    angle = ANGLES["right elbow, bend"]
    right, left = recorded(joints), recorded(mirror_joints(joints), handedness="left")
    np.testing.assert_allclose(angle.of(left.joints), angle.of(right.joints))


def test_joints_that_a_source_lacks_leave_their_angles_out_and_no_others() -> None:
    joints = standing()
    joints[:, [Joint.HIP_LEFT, Joint.HIP_RIGHT, Joint.HIP_CENTER]] = np.nan
    spread = {name: spread_of(angle, [recorded(joints)]) for name, angle in ANGLES.items()}
    assert np.isnan(spread["right thigh from the trunk's line"].median)
    assert np.isfinite(spread["right elbow, bend"].median)


def test_frames_are_covered_where_they_lie_in_the_others_usual_range() -> None:
    angle, joints = ANGLES["right elbow, bend"], standing(11)
    bent = joints.copy()
    bent[:6, Joint.WRIST_RIGHT] = bent[:6, Joint.SHOULDER_RIGHT] + (0.1, 0.0, 0.0)
    people = [recorded(joints, "a"), recorded(joints, "b")]
    spread = spread_of(angle, people)
    assert spread.between_people == pytest.approx(0.0)
    assert share_within(angle, [recorded(bent)], replace(spread, lowest=-1.0)) == 5 / 11


@needs_real_data
@pytest.mark.long
def test_two_real_sources_stand_beside_the_simulated_people_who_do_the_same() -> None:
    """It alone reads the real sources as the verb does, and simulates people for them."""
    sources = recorded_sources(DATA)
    assert [len({one.participant for one in source.recordings}) for source in sources] == [8, 1]
    golf = sources[1]
    rows = compare_postures(golf, seed=0)
    assert [row.angle for row in rows] == list(ANGLES)
    assert all(np.isfinite(row.real.median) and np.isfinite(row.covered) for row in rows)
    assert np.isnan(compare_variety(golf, seed=0).real)
