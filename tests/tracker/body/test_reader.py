import numpy as np
import pytest
from inhand_tracker.body.reader import BodyReader
from people import STANDING, STANDING_HEIGHT, wave_model

HEAD, ANKLE = 3, 14


def reader() -> BodyReader:
    return BodyReader(wave_model().mapping, left_handed=False)


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
