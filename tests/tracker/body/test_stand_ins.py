"""Stand-ins for joints that no recording has."""

from dataclasses import dataclass

import numpy as np
import pytest
from inhand_schemas.joints import JOINT_NAMES, Joint
from inhand_tracker.body.reader import BodyReader
from inhand_tracker.body.skeleton import (
    body_pose,
    mirror_joints,
    part_lengths,
    pelvis_basis,
    stature,
    stature_of,
    typical_lengths,
)
from inhand_tracker.body.stand_ins import REPLACEABLE, put_stand_ins, seen_stature
from scipy.spatial.transform import Rotation
from waving import STANDING, waving

LEGS = tuple(i for i, name in enumerate(JOINT_NAMES) if name.startswith(("Knee", "Ankle", "Foot")))
PELVIS = (Joint.HIP_CENTER, Joint.SPINE, Joint.HIP_LEFT, Joint.HIP_RIGHT)
KINDS = [
    LEGS,
    (*LEGS, Joint.HIP_LEFT, Joint.HIP_RIGHT),
    (*LEGS, Joint.HIP_CENTER, Joint.SPINE),
    (*LEGS, *PELVIS),
    REPLACEABLE,
]


@dataclass(frozen=True)
class Learned:
    """Body poses of the people who were learned from, (N, 60)."""

    body_poses: np.ndarray


def without(joints: np.ndarray, absent: tuple[int, ...]) -> np.ndarray:
    lacking = joints.copy()
    lacking[..., list(absent), :] = np.nan
    return lacking


@pytest.mark.parametrize("absent", KINDS)
class TestStandIns:
    def test_they_are_about_where_the_joints_of_somebody_who_stands_are(
        self, absent: tuple[int, ...]
    ) -> None:
        seen = without(STANDING, absent)
        height = seen_stature(part_lengths(seen), absent)
        assert height == pytest.approx(stature(part_lengths(STANDING)), rel=0.2)
        placed = put_stand_ins(seen, absent, height)
        assert np.linalg.norm(placed - STANDING, axis=1).max() < 0.35
        kept = [joint for joint in range(20) if joint not in absent]
        np.testing.assert_array_equal(placed[kept], STANDING[kept])

    def test_they_go_with_a_body_that_is_turned_moved_or_mirrored(
        self, absent: tuple[int, ...]
    ) -> None:
        turn = Rotation.from_euler("xyz", (0.4, 1.9, -0.7))
        placed = put_stand_ins(STANDING, absent, 1.7)
        moved = np.array([1.0, -2.0, 0.5])
        elsewhere = put_stand_ins(turn.apply(STANDING) + moved, absent, 1.7)
        np.testing.assert_allclose(elsewhere, turn.apply(placed) + moved, atol=1e-9)
        mirrored = put_stand_ins(mirror_joints(STANDING), absent, 1.7)
        np.testing.assert_allclose(mirrored, mirror_joints(placed), atol=1e-9)

    def test_what_is_read_live_is_what_is_learned_from(self, absent: tuple[int, ...]) -> None:
        joints, _, _ = waving(400, 3)
        height = seen_stature(typical_lengths(part_lengths(without(joints, absent))), absent)
        learned = put_stand_ins(joints, absent, height)
        poses = body_pose(learned, pelvis_basis(learned), stature_of(learned))
        reader = BodyReader(Learned(poses), left_handed=False, absent=absent)
        for frame in range(350):
            body = reader.read(without(joints[frame], absent))
        assert body is not None
        np.testing.assert_allclose(body.pose, poses[349], atol=0.003)

    def test_whoever_has_the_joints_after_all_is_read_as_if_without(
        self, absent: tuple[int, ...]
    ) -> None:
        joints, _, _ = waving(20, 3)
        poses = Learned(put_stand_ins(joints, absent, 1.7).reshape(20, 60))
        readers = [BodyReader(poses, left_handed=True, absent=absent) for _ in range(2)]
        for frame in joints:
            whole, lacking = (
                reader.read(one)
                for reader, one in zip(readers, (frame, without(frame, absent)), strict=True)
            )
            assert whole is not None
            assert lacking is not None
            np.testing.assert_array_equal(whole.joints, lacking.joints)


def test_nothing_is_read_while_nothing_shows_how_tall_somebody_is() -> None:
    absent = (*LEGS, *PELVIS)
    unknown = np.full((20, 3), np.nan)
    reader = BodyReader(Learned(np.zeros((1, 60))), left_handed=False, absent=absent)
    assert reader.read(unknown) is None
    assert np.isnan(seen_stature(part_lengths(unknown), absent))
    assert np.isnan(seen_stature(part_lengths(unknown), LEGS))
