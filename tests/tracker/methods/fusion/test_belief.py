"""What is carried over from frame to frame, on poses that are known."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_schemas.joints import Joint
from inhand_tracker.body.anchors import find_anchors
from inhand_tracker.body.holders import find_holder
from inhand_tracker.body.reader import BodyReader
from inhand_tracker.body.skeleton import mirror_joints
from inhand_tracker.body.window import BodyWindow
from inhand_tracker.geometry.pose_gaussian import PoseGaussian
from inhand_tracker.methods.fusion.belief import (
    Belief,
    BodyExpectation,
    Expected,
    carry_over,
    expect_afresh,
    steady_before,
)
from inhand_tracker.methods.fusion.parameters import DEFAULT_FUSION
from people import (
    FRAME_NS,
    quaternion_of,
    same_rotation,
    scipy_rotation,
    unseen_wave,
    wave_model,
)
from scipy.spatial.transform import Rotation

SECOND = 1_000_000_000
EXACT = replace(DEFAULT_FUSION, forgetting_s=1e12)
FOR_EVER_S = 1e12


def gaussian(place: list[float], turn: list[float], deviation: float = 0.1) -> PoseGaussian:
    rotation = quaternion_of(Rotation.from_rotvec(turn))
    return PoseGaussian(np.array(place), rotation, deviation**2 * np.eye(6))


EXPECTED = gaussian([0.1, 0.2, 2.0], [0.3, 0.0, 0.5])
BELIEVED = gaussian([0.15, 0.18, 2.02], [0.4, 0.1, 0.5], 0.02)
ALONE = Expected(EXPECTED)
BEFORE = Belief(ALONE, BELIEVED, SECOND)


def in_object(expected: PoseGaussian, pose: PoseGaussian) -> tuple[np.ndarray, np.ndarray]:
    """How a pose differs from the expected one, in its frame: a shift and a rotation vector."""
    inverse = scipy_rotation(expected.rotation).inv()
    shift = inverse.apply(pose.centre - expected.centre)
    return shift, (inverse * scipy_rotation(pose.rotation)).as_rotvec()


def test_the_difference_stays_in_the_object_s_own_frame() -> None:
    now = gaussian([-0.5, 0.4, 1.5], [-1.0, 2.0, 0.2])
    stays, *_ = carry_over(BEFORE, Expected(now), 2 * SECOND, FOR_EVER_S, EXACT).parts
    for one, other in zip(in_object(now, stays), in_object(EXPECTED, BELIEVED), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-9)


def test_the_difference_fades_with_the_prior_s_persistence() -> None:
    stays, *_ = carry_over(BEFORE, ALONE, 3 * SECOND, 2.0, EXACT).parts
    for one, other in zip(in_object(EXPECTED, stays), in_object(EXPECTED, BELIEVED), strict=True):
        np.testing.assert_allclose(one, np.exp(-1.0) * other, atol=1e-9)


def test_its_covariance_turns_with_it_and_fades_into_the_expected_one() -> None:
    flat = replace(BELIEVED, covariance=np.diag([0.01, 0.04, 0.09, 0.1, 0.2, 0.3]) ** 2)
    before = replace(BEFORE, believed=flat)
    turned = gaussian([0.1, 0.2, 2.0], [0.3, 1.5, 0.5])
    stays, *_ = carry_over(before, Expected(turned), 2 * SECOND, FOR_EVER_S, EXACT).parts
    turn = (scipy_rotation(stays.rotation) * scipy_rotation(flat.rotation).inv()).as_matrix()
    axes = np.kron(np.eye(2), turn)
    np.testing.assert_allclose(stays.covariance, axes @ flat.covariance @ axes.T, atol=1e-12)
    late, *_ = carry_over(before, Expected(turned), 100 * SECOND, FOR_EVER_S, DEFAULT_FUSION).parts
    np.testing.assert_allclose(late.covariance, turned.covariance, atol=1e-12)


def test_an_object_that_was_left_stays_and_grows_less_certain() -> None:
    now = gaussian([-0.5, 0.4, 1.5], [-1.0, 2.0, 0.2])
    mixture = carry_over(BEFORE, Expected(now), 2 * SECOND, FOR_EVER_S, DEFAULT_FUSION)
    stays, *_, left = mixture.parts
    assert [mixture.parts[one] for one in mixture.carried] == [stays, left]
    np.testing.assert_array_equal(left.centre, BELIEVED.centre)
    assert same_rotation(left.rotation, BELIEVED.rotation)
    grown = np.diag(left.covariance - BELIEVED.covariance)
    np.testing.assert_allclose(grown, np.square([0.01] * 3 + [0.05] * 3))


def test_without_a_reason_to_doubt_each_part_has_its_share() -> None:
    same = Belief(ALONE, EXPECTED, SECOND)
    believed = carry_over(same, ALONE, 2 * SECOND, 1.0, DEFAULT_FUSION)
    np.testing.assert_allclose(believed.weights, [0.6, 0.2, 0.2])
    assert believed.parts[1] is EXPECTED
    never_left = replace(DEFAULT_FUSION, leaves=False)
    believed = carry_over(same, ALONE, 2 * SECOND, 1.0, never_left)
    np.testing.assert_allclose(believed.weights, [0.75, 0.25])


@pytest.mark.parametrize("doubt", [1.0, 4.0])
def test_a_part_that_strays_from_the_expected_pose_loses_weight(doubt: float) -> None:
    """The body walks on by two standard deviations: an object that stayed is less likely."""
    same = Belief(ALONE, EXPECTED, SECOND)
    now = replace(EXPECTED, centre=EXPECTED.centre + np.array([0.2, 0.0, 0.0]))
    weights = carry_over(
        same, Expected(now), 2 * SECOND, FOR_EVER_S, replace(EXACT, doubt=doubt)
    ).weights
    assert weights[2] / weights[1] == pytest.approx(np.exp(-0.5 * 2.0**2 / doubt))
    assert weights[0] / weights[1] == pytest.approx(3.0)


AT_REST = Belief(ALONE, BELIEVED, SECOND, replace(BEFORE, time_ns=SECOND - FRAME_NS))


def leapt(metres: float, before: Belief = AT_REST, *, frames: int = 1) -> np.ndarray:
    """The weights of what is believed when the body goes so far, the last two of where the object
    was and of how it went."""
    now = replace(EXPECTED, centre=EXPECTED.centre + np.array([metres, 0.0, 0.0]))
    time_ns = SECOND + frames * FRAME_NS
    return carry_over(before, Expected(now), time_ns, FOR_EVER_S, DEFAULT_FUSION).weights


def test_a_body_that_leaps_may_be_wrong_however_far_it_leaps() -> None:
    for metres in (0.2, 2.0):
        weights = leapt(metres)
        assert len(weights) == 4
        assert weights[2:].sum() == pytest.approx(DEFAULT_FUSION.leap_doubt)
    assert len(leapt(0.05)) == 3


def test_a_body_that_was_on_its_way_or_had_time_does_not_leap() -> None:
    faster = replace(BELIEVED, centre=BELIEVED.centre - np.array([0.15, 0.0, 0.0]))
    moving = replace(AT_REST, earlier=replace(BEFORE, believed=faster, time_ns=SECOND - FRAME_NS))
    assert len(leapt(0.35, moving)) == 3
    assert len(leapt(0.35, frames=10)) == 3
    assert len(leapt(0.35, replace(AT_REST, earlier=None))) == 3


def believed_apart(metres: float, *, after_ns: int = FRAME_NS) -> Belief:
    """A frame in which the object was believed to have stayed, as the body had it so far away; so
    long after it leapt."""
    far = replace(EXPECTED, centre=BELIEVED.centre + np.array([metres, 0.0, 0.0]))
    steady = replace(AT_REST, earlier=None, time_ns=SECOND - after_ns)
    return replace(AT_REST, expected=Expected(far), steady=steady)


def test_a_body_that_stays_away_where_it_leapt_to_may_be_wrong_until_it_is_back_or_long_away() -> (
    None
):
    """A wrist that is lost jumps, and stays off for several frames."""
    away = believed_apart(0.4)
    now = Expected(replace(EXPECTED, centre=away.expected.whole.centre + 0.01))
    mixed = carry_over(away, now, SECOND + FRAME_NS, FOR_EVER_S, DEFAULT_FUSION)
    assert mixed.weights[2:].sum() == pytest.approx(DEFAULT_FUSION.leap_doubt)
    # If the body is right, the object differs from it as it did before the leap.
    of_body = mixed.parts[0].centre - now.whole.centre
    assert np.linalg.norm(of_body) < 1.5 * np.linalg.norm(BELIEVED.centre - EXPECTED.centre)
    near = Expected(replace(EXPECTED, centre=BELIEVED.centre + 0.02))
    assert steady_before(away, near, SECOND + FRAME_NS, DEFAULT_FUSION) is not None
    slow = replace(away, expected=near)
    assert steady_before(slow, near, SECOND + FRAME_NS, DEFAULT_FUSION) is None
    late = believed_apart(0.4, after_ns=SECOND)
    assert steady_before(late, now, SECOND + FRAME_NS, DEFAULT_FUSION) is None


# --- Postures unlike all that were learned

HELD = gaussian([0.3, 0.2, 2.1], [0.3, 1.0, 0.5], 0.05)
LAIN = gaussian([-0.4, 0.5, 1.9], [0.0, 0.0, 0.0], 0.05)
STRANGE = Expected(EXPECTED, (HELD, LAIN), 0.9)


def test_in_a_strange_posture_an_object_is_held_or_where_people_had_it_and_not_between() -> None:
    afresh = expect_afresh(STRANGE)
    assert afresh.parts == (HELD, LAIN)
    np.testing.assert_allclose(afresh.weights, [0.9, 0.1])
    assert expect_afresh(ALONE).parts == (EXPECTED,)


def test_in_a_strange_posture_the_difference_from_the_hold_stays() -> None:
    now = gaussian([-0.5, 0.4, 1.5], [-1.0, 2.0, 0.2])
    before = Belief(STRANGE, BELIEVED, SECOND)
    strange = replace(STRANGE, alternatives=(now, LAIN))
    stays, *_ = carry_over(before, strange, 2 * SECOND, FOR_EVER_S, EXACT).parts
    for one, other in zip(in_object(now, stays), in_object(HELD, BELIEVED), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-9)


def test_in_a_strange_posture_alone_it_may_go_on_as_it_went() -> None:
    step, turn = np.array([0.1, 0.0, -0.05]), Rotation.from_rotvec([0.0, 0.2, 0.1])
    moved = replace(
        BELIEVED,
        centre=BELIEVED.centre + step,
        rotation=quaternion_of(turn * scipy_rotation(BELIEVED.rotation)),
    )
    before = Belief(STRANGE, moved, 2 * SECOND, Belief(STRANGE, BELIEVED, SECOND))
    *_, goes_on = carry_over(before, STRANGE, 4 * SECOND, FOR_EVER_S, EXACT).parts
    np.testing.assert_allclose(goes_on.centre, moved.centre + 2 * step, atol=1e-12)
    assert same_rotation(goes_on.rotation, quaternion_of(turn**2 * scipy_rotation(moved.rotation)))
    of_change = np.diag(np.square([0.02] * 3 + [0.1] * 3))
    grown = 3**2 * moved.covariance + 2**2 * BELIEVED.covariance + of_change
    np.testing.assert_allclose(goes_on.covariance, grown, atol=1e-12)
    assert len(carry_over(before, ALONE, 4 * SECOND, FOR_EVER_S, EXACT).parts) == 3


def strange_joints() -> np.ndarray:
    """Shoulders and knees elsewhere than anybody's who taught."""
    joints = unseen_wave(5)[-1].copy()
    joints[[Joint.SHOULDER_CENTER, Joint.SHOULDER_LEFT, Joint.SHOULDER_RIGHT], 1] += 0.15
    joints[[Joint.KNEE_LEFT, Joint.KNEE_RIGHT], 2] += 0.30
    return joints


def expected_of(joints: np.ndarray, *, left_handed: bool = False) -> Expected:
    model = wave_model()
    body = BodyReader(model.mapping, left_handed=left_handed).read(joints)
    assert model.prior is not None
    assert body is not None
    expectation = BodyExpectation(model.prior, model.shape.mirror_normal, left_handed)
    described = BodyWindow().add(body.joints, FRAME_NS, body.height)
    return expectation.expect(body, described)


def test_an_object_that_is_held_turns_about_the_hand_as_surely_as_people_hold_it() -> None:
    """However wide the whole is: a body that stands strangely has its hands where they are seen."""
    prior, joints = wave_model().prior, strange_joints()
    assert prior is not None
    assert prior.hold is not None
    expected = expected_of(joints)
    assert expected.strange
    assert expected.alternatives is not None
    held, _ = expected.alternatives
    hand, _, _ = find_holder(find_anchors(joints), prior.hold.holder)
    np.testing.assert_allclose(held.centre, hand, atol=1e-9)
    assert 2.0 * held.covariance[0, 0] < expected.whole.covariance[0, 0]


def test_a_left_handed_person_s_is_the_mirror_image() -> None:
    joints = strange_joints()
    right, left = expected_of(joints), expected_of(mirror_joints(joints), left_handed=True)
    assert right.alternatives is not None
    assert left.alternatives is not None
    for one, other in zip(
        (right.whole, *right.alternatives), (left.whole, *left.alternatives), strict=True
    ):
        np.testing.assert_allclose(other.centre, one.centre * [-1.0, 1.0, 1.0], atol=1e-6)
        np.testing.assert_allclose(
            np.diag(other.covariance), np.diag(one.covariance), rtol=1e-4, atol=1e-9
        )
