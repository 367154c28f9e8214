"""Joints in a picture, lifted by its depth."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_capture.estimation.body_lengths import BodyLengths
from inhand_capture.estimation.found_person import FoundPerson
from inhand_capture.estimation.lifting import DepthPicture, Lifted, Lifter, lens_of
from inhand_capture.estimation.limbs import LIMBS, TRUNK_ENDS
from inhand_schemas.joints import Joint
from numpy.typing import NDArray
from posed_person import (
    INFO,
    KNOWN,
    LENS,
    depth_of,
    draw_ball,
    picture,
    pixels_of,
    seen,
    standing,
)

UNKNOWN = np.full((20, 3), np.nan)
CLOSE_M = 0.06


def lifted(
    person: FoundPerson, of: DepthPicture, before: NDArray[np.float64] = UNKNOWN
) -> Lifted | None:
    lifter = Lifter(LENS)
    surfaces = lifter.read(person, of)
    return surfaces and lifter.lift(person, surfaces, BodyLengths(), before)


def errors(found: Lifted | None, truth: NDArray[np.float64]) -> NDArray[np.float64]:
    assert found is not None
    distances: NDArray[np.float64] = np.linalg.norm(found.seen - truth, axis=1)[KNOWN]
    return distances


@pytest.mark.parametrize("depths", [True, False], ids=["with its depths", "without"])
def test_joints_come_back_from_the_depth_of_their_skin(depths: bool) -> None:
    truth = standing()
    found = lifted(seen(truth, depths=depths), picture(truth))
    assert errors(found, truth).max() < CLOSE_M


def test_depth_of_another_size_than_the_picture_serves_as_well() -> None:
    truth = standing()
    half = DepthPicture(depth_of(truth)[::2, ::2], 0.001)
    assert errors(lifted(seen(truth), half), truth).max() < 1.5 * CLOSE_M


def test_a_hand_before_the_trunk_is_where_it_is_and_so_is_the_trunk() -> None:
    truth = standing()
    truth[Joint.ELBOW_LEFT] = (0.27, -0.2, 2.40)
    truth[Joint.WRIST_LEFT] = (0.07, -0.1, 2.27)
    truth[Joint.HAND_LEFT] = (0.0, -0.08, 2.22)
    assert errors(lifted(seen(truth), picture(truth)), truth).max() < CLOSE_M


def test_a_joint_behind_a_thing_is_inferred_and_not_in_the_thing() -> None:
    truth = standing()
    depth = depth_of(truth).astype(float)
    knee = truth[Joint.KNEE_LEFT]
    draw_ball(depth, np.array([knee[0] * 0.6, knee[1] * 0.6, knee[2] * 0.6]), 0.12)
    found = lifted(seen(truth), DepthPicture(depth.astype(np.uint16), 0.001))
    assert errors(found, truth).max() < 0.15
    assert found is not None
    assert found.states[Joint.KNEE_LEFT] == 1


def test_a_hip_behind_a_thing_is_inferred_and_the_trunk_stays_where_it_is() -> None:
    truth = standing()
    depth = depth_of(truth).astype(float)
    for hip in (Joint.HIP_LEFT, Joint.HIP_RIGHT):
        draw_ball(depth, 0.8 * truth[hip], 0.12)
    found = lifted(seen(truth), DepthPicture(depth.astype(np.uint16), 0.001))
    assert errors(found, truth).max() < 0.15
    assert found is not None
    assert set(found.states[[Joint.HIP_LEFT, Joint.HIP_RIGHT]]) == {1}


@pytest.mark.parametrize("depths", [True, False], ids=["with its depths", "without"])
def test_who_bends_towards_the_camera_has_shoulders_before_the_hips(depths: bool) -> None:
    truth, bend = standing(), np.radians(70.0)
    hips = truth[[Joint.HIP_LEFT, Joint.HIP_RIGHT]].mean(axis=0)
    legs = [
        joint for joint in Joint if joint.name.split("_")[0] in ("HIP", "KNEE", "ANKLE", "FOOT")
    ]
    upper = [joint for joint in Joint if joint not in legs]
    up, ahead = hips[1] - truth[upper, 1], hips[2] - truth[upper, 2]
    truth[upper, 1] = hips[1] - np.cos(bend) * up + np.sin(bend) * ahead
    truth[upper, 2] = hips[2] - np.sin(bend) * up - np.cos(bend) * ahead
    found = lifted(seen(truth, depths=depths), picture(truth))
    assert found is not None
    shoulders = [Joint.SHOULDER_LEFT, Joint.SHOULDER_RIGHT]
    assert np.linalg.norm(found.seen - truth, axis=1)[shoulders].max() < 0.12


def test_a_pixel_beside_a_thin_limb_does_not_put_the_joint_on_the_wall() -> None:
    truth = standing()
    person = seen(truth)
    beside = person.pixels.copy()
    beside[Joint.WRIST_LEFT, 0] += 9.0
    found = lifted(replace(person, pixels=beside), picture(truth))
    assert found is not None
    assert found.seen[Joint.WRIST_LEFT, 2] < truth[Joint.WRIST_LEFT, 2] + 0.15


def test_a_hand_that_is_far_beyond_its_arm_is_missing() -> None:
    truth = standing()
    person = seen(truth)
    away = person.pixels.copy()
    away[[Joint.WRIST_LEFT, Joint.HAND_LEFT], 0] += 250.0
    found = lifted(replace(person, pixels=away), picture(truth))
    assert found is not None
    assert (found.states[[Joint.WRIST_LEFT, Joint.HAND_LEFT]] == 0).all()
    assert np.isnan(found.joints[[Joint.WRIST_LEFT, Joint.HAND_LEFT]]).all()
    assert found.states[Joint.ELBOW_LEFT] == 2


def test_holes_leave_joints_inferred_where_the_network_says() -> None:
    truth = standing()
    depth = depth_of(truth)
    x, y = pixels_of(truth)[Joint.HAND_RIGHT].astype(int)
    depth[y - 15 : y + 15, x - 15 : x + 15] = 0
    found = lifted(seen(truth), DepthPicture(depth, 0.001))
    assert errors(found, truth).max() < 0.1
    assert found is not None
    assert found.states[Joint.HAND_RIGHT] == 1


def test_the_trunk_s_joints_and_what_a_network_lacks_are_derived_and_inferred() -> None:
    truth = standing()
    person = seen(truth)
    lacking = [Joint.HAND_LEFT, Joint.HAND_RIGHT, Joint.FOOT_LEFT, Joint.FOOT_RIGHT]
    pixels = person.pixels.copy()
    pixels[lacking] = np.nan
    found = lifted(replace(person, pixels=pixels), picture(truth))
    assert found is not None
    derived = [Joint.HIP_CENTER, Joint.SPINE, Joint.SHOULDER_CENTER, *lacking]
    assert (found.states[derived] == 1).all()
    assert np.isfinite(found.joints).all()
    assert np.linalg.norm(found.joints[lacking] - truth[lacking], axis=1).max() < 0.12
    assert found.joints[Joint.SPINE, 1] < found.joints[Joint.HIP_CENTER, 1]


def test_a_network_that_knows_the_trunk_alone_gives_no_limbs_and_a_derived_head() -> None:
    truth = standing()
    person = seen(truth, depths=False)
    trunk = np.isin(np.arange(20), TRUNK_ENDS)
    alone = np.where(trunk[:, None], person.pixels, np.nan)
    found = lifted(replace(person, pixels=alone, visibilities=trunk.astype(float)), picture(truth))
    assert found is not None
    assert found.states[Joint.HEAD] == 1
    assert np.linalg.norm(found.joints[Joint.HEAD] - truth[Joint.HEAD]) < 0.12
    limbs = [joint for limb in LIMBS for joint in limb[1:]]
    assert (found.states[limbs] == 0).all()
    assert np.isnan(found.joints[limbs]).all()


def test_ends_of_limbs_out_of_the_picture_are_missing() -> None:
    truth = standing(z=1.5)
    person = seen(truth)
    inside = person.pixels[:, 1] < LENS.height
    assert not inside[Joint.FOOT_LEFT]
    hardly = np.where(inside, person.visibilities, 0.1)
    found = lifted(replace(person, visibilities=hardly), picture(truth))
    assert found is not None
    assert found.states[Joint.FOOT_LEFT] == 0
    assert np.isnan(found.joints[Joint.FOOT_LEFT]).all()
    assert found.states[Joint.KNEE_LEFT] in (1, 2)


def test_what_is_too_small_or_without_depth_is_no_person() -> None:
    truth = standing()
    flat = standing()
    flat[:, :2] = flat[:, :2] * 0.25
    poster = DepthPicture(np.full((LENS.height, LENS.width), int(1000 * 2.5), np.uint16), 0.001)
    assert lifted(seen(flat), poster) is None
    nothing = DepthPicture(np.zeros((LENS.height, LENS.width), np.uint16), 0.001)
    assert lifted(seen(truth), nothing) is None


def test_a_lens_is_that_of_the_size_of_the_picture() -> None:
    half = lens_of(INFO, 320, 240)
    truth = standing()
    pixels = (pixels_of(truth) + 0.5) / 2 - 0.5
    np.testing.assert_allclose(half.rays(pixels), LENS.rays(pixels_of(truth)))


def test_own_lengths_are_known_after_some_frames_that_measured_them() -> None:
    truth, body = standing(), BodyLengths()
    states = np.where(KNOWN, 2, 0).astype(np.uint8)
    states[Joint.KNEE_LEFT] = 1
    for _ in range(9):
        body.add(truth, states)
    assert np.isnan(body.lengths).all()
    body.add(truth, states)
    assert body.trunk == pytest.approx(0.5)
    forearm = np.linalg.norm(truth[Joint.WRIST_LEFT] - truth[Joint.ELBOW_LEFT])
    assert body.lengths[Joint.WRIST_LEFT] == pytest.approx(forearm)
    assert np.isnan(body.lengths[[Joint.KNEE_LEFT, Joint.ANKLE_LEFT]]).all()
    assert np.isfinite(body.lengths[Joint.KNEE_RIGHT])
