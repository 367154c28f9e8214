"""Bodies are whole, of one height, and right-handed, whatever joints are given."""

from types import SimpleNamespace

import numpy as np
import pytest
from inhand_tracker.body.reader import Body, BodyReader
from inhand_tracker.body.skeleton import body_pose, mirror_joints, pelvis_basis
from people import STANDING, STANDING_HEIGHT, waving

HEAD, ANKLE = 3, 14


_PEOPLE = waving(30)
LEARNED = SimpleNamespace(body_poses=body_pose(_PEOPLE, pelvis_basis(_PEOPLE), STANDING_HEIGHT))


def reader(*, left_handed: bool = False) -> BodyReader:
    return BodyReader(LEARNED, left_handed=left_handed)


def without(*joints: int) -> np.ndarray:
    missing = STANDING.copy()
    missing[list(joints)] = np.nan
    return missing


@pytest.mark.parametrize("joint", [HEAD, ANKLE])
@pytest.mark.parametrize("away", [0.9, 5.0, 500.0])
def test_a_wild_joint_in_the_first_frame_does_not_change_the_height(
    joint: int, away: float
) -> None:
    wild = STANDING.copy()
    wild[joint, 1] += away
    body = reader().read(wild)
    assert body is not None
    assert body.height == pytest.approx(STANDING_HEIGHT, rel=0.03)


@pytest.mark.parametrize("scale", [0.5, 2.0])
def test_small_and_large_people_keep_their_size(scale: float) -> None:
    body = reader().read(scale * STANDING)
    assert body is not None
    assert body.height == pytest.approx(scale * STANDING_HEIGHT, rel=1e-6)


@pytest.mark.parametrize("absurd", [1e5, 1e150, -1e300, np.inf])
def test_absurd_joints_are_missing_ones(absurd: float) -> None:
    joints, missing = STANDING.copy(), STANDING.copy()
    joints[11, 2], missing[11] = absurd, np.nan
    given, expected = reader().read(joints), reader().read(missing)
    assert given is not None
    assert expected is not None
    np.testing.assert_array_equal(given.pose, expected.pose)
    np.testing.assert_array_equal(given.parts.rotations, expected.parts.rotations)


def test_an_absurd_pelvis_is_no_body() -> None:
    assert reader().read(np.full((20, 3), 1e150)) is None
    assert reader().read(1e150 * STANDING) is None


def test_what_is_given_is_not_changed() -> None:
    joints = STANDING.copy()
    joints[11] = 1e150
    before = joints.copy()
    reader().read(joints)
    np.testing.assert_array_equal(joints, before)


def test_a_missing_joint_keeps_its_last_place_on_the_body() -> None:
    running, shift = reader(), np.array([0.5, 0.0, 1.0])
    running.read(STANDING)
    body = running.read(without(11) + shift)
    assert body is not None
    np.testing.assert_allclose(body.joints, STANDING + shift, atol=1e-9)


def test_a_joint_that_was_never_seen_is_where_people_usually_have_it() -> None:
    body = reader().read(without(11))
    assert body is not None
    usual = LEARNED.body_poses.mean(axis=0).reshape(20, 3)[11]
    np.testing.assert_allclose(body.pose.reshape(20, 3)[11], usual)
    np.testing.assert_allclose(np.delete(body.joints, 11, axis=0), np.delete(STANDING, 11, axis=0))


def test_a_left_handed_person_is_read_as_the_mirror_shows_a_right_handed_one() -> None:
    left, right = reader(left_handed=True).read(mirror_joints(STANDING)), reader().read(STANDING)
    assert isinstance(left, Body)
    assert isinstance(right, Body)
    np.testing.assert_array_equal(left.joints, right.joints)
    np.testing.assert_array_equal(left.pose, right.pose)
