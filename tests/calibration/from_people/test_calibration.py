"""Calibration from people: cameras and clocks are found, whatever people and cameras do."""

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from inhand_calibration.errors import CalibrationError
from inhand_calibration.from_people.calibration import PosePrior, calibrate_from_people
from inhand_calibration.from_people.parameters import DEFAULT_PEOPLE_CALIBRATION
from inhand_calibration.rigid import rigid, to_pose
from inhand_runtime.rig_calibration import read_rig_calibration, write_rig_calibration
from inhand_schemas.joints import MIRRORED_JOINTS, Joint
from wanderers import (
    BACK,
    FRONT,
    LEFT,
    SECONDS,
    circling_movement,
    errors_of,
    pacing_movement,
    part_of,
    still_movement,
    together,
    transform_of,
    true_movement,
    watch,
    with_joints,
    within_aims,
)


def test_three_cameras_are_placed_and_their_clocks_set() -> None:
    walk = true_movement(1)
    cameras = [watch(camera, walk) for camera in (FRONT, LEFT, BACK)]
    found = calibrate_from_people(cameras, "front")
    assert within_aims([errors_of(found, FRONT, camera) for camera in (LEFT, BACK)])
    assert found.warnings == ()
    assert found.cameras["back"].moments > 150
    assert found.cameras["left"].residual_m == pytest.approx(0.009, abs=0.003)
    assert found.cameras["front"].clock_offset_ns == 0
    assert not found.cameras["front"].covariance.any()


def test_any_camera_can_be_the_reference() -> None:
    walk = true_movement(2)
    found = calibrate_from_people([watch(FRONT, walk), watch(BACK, walk)], "back")
    assert within_aims([errors_of(found, BACK, FRONT)])


def test_cameras_of_unlike_rates_agree_and_are_less_sure_of_their_clocks() -> None:
    fast = replace(LEFT, frame_rate=30.0)
    walk = true_movement(3)
    cameras = [watch(FRONT, walk), watch(fast, walk)]
    found = calibrate_from_people(cameras, "front")
    assert within_aims([errors_of(found, FRONT, fast)])
    # A filter's delay is a matter of frames, and 15 Hz and 30 Hz differ by 33 ms.
    assert found.cameras["left"].clock_deviation_ns > 9e6


def test_a_clock_that_has_nothing_to_do_with_the_others_is_found() -> None:
    walk = true_movement(4)
    since_start = replace(LEFT, offset_s=-86_400.0)
    seen = watch(since_start, walk)
    found = calibrate_from_people([watch(FRONT, walk), seen], "front")
    assert within_aims([errors_of(found, FRONT, since_start)])


def test_drifting_clocks_are_found_for_the_middle_of_the_recording() -> None:
    walk = true_movement(5)
    drifting = replace(LEFT, drift=100e-6, offset_s=0.0)
    found = calibrate_from_people([watch(FRONT, walk), watch(drifting, walk)], "front")
    assert found.cameras["left"].clock_offset_ns == pytest.approx(1e-4 * SECONDS / 2 * 1e9, abs=5e6)


def test_a_camera_that_takes_left_for_right_behind_people_is_placed() -> None:
    walk = true_movement(6)
    seen = watch(BACK, walk)
    chest = seen.joints[:, Joint.SHOULDER_LEFT] - seen.joints[:, Joint.SHOULDER_RIGHT]
    away = np.flatnonzero(chest[:, 0] < 0.0)
    assert 0.2 < len(away) / len(chest) < 0.8
    joints = seen.joints.copy()
    joints[away] = joints[away][:, list(MIRRORED_JOINTS)]
    found = calibrate_from_people([watch(FRONT, walk), with_joints(seen, joints)], "front")
    assert within_aims([errors_of(found, FRONT, BACK)])


def test_a_camera_that_hangs_upside_down_is_placed_where_its_skeletons_are_right() -> None:
    walk = true_movement(7)
    seen = watch(LEFT, walk)
    hanging = with_joints(seen, seen.joints * [-1.0, -1.0, 1.0])
    found = calibrate_from_people([watch(FRONT, walk), hanging], "front")
    pose = transform_of(found.cameras["left"].rig_from_camera)
    assert pose.rotation[2, 1] > 0.9


def test_people_are_told_apart_and_numbered_anew() -> None:
    one, other = true_movement(8), true_movement(9) + np.array([0.4, 0.0, 0.0])
    front = together(watch(FRONT, one, person=0), watch(FRONT, other, person=1))
    seen = watch(LEFT, one, person=5)
    # The left camera loses the first person now and then, and sees the other for a while only.
    lost = replace(seen, people=seen.people + np.arange(len(seen.people)) // 100)
    left = together(lost, part_of(watch(LEFT, other, person=9), 0.5, 0.9))
    found = calibrate_from_people([front, left], "front")
    assert within_aims([errors_of(found, FRONT, LEFT)])


def test_what_hangs_still_for_the_whole_time_is_no_person() -> None:
    walk, coat = true_movement(10), still_movement(11) + np.array([0.5, 0.5, 0.0])
    cameras = [
        together(watch(camera, walk, person=0), watch(camera, coat, noise=0.002, person=1))
        for camera in (FRONT, LEFT)
    ]
    found = calibrate_from_people(cameras, "front")
    assert within_aims([errors_of(found, FRONT, LEFT)])


def test_cameras_that_share_nobody_are_placed_through_a_third() -> None:
    walk = true_movement(12, seconds=45.0)
    early, late = part_of(watch(LEFT, walk), 0.0, 0.45), part_of(watch(BACK, walk), 0.5, 1.0)
    found = calibrate_from_people([early, watch(FRONT, walk), late], "left")
    errors = errors_of(found, LEFT, BACK)
    assert errors.translation < 0.03
    assert errors.rotation < 0.7
    assert errors.clock < 0.01


def test_cameras_of_trackers_that_see_the_skin_are_not_brought_together() -> None:
    walk = true_movement(13)
    cameras = []
    for camera in (FRONT, BACK):
        seen = watch(camera, walk)
        length = np.linalg.norm(seen.joints, axis=2, keepdims=True)
        cameras.append(with_joints(seen, seen.joints * (1.0 - 0.02 / length)))
    wide = replace(DEFAULT_PEOPLE_CALIBRATION.refinement, surface_m=0.02)
    parameters = replace(DEFAULT_PEOPLE_CALIBRATION, refinement=wide)
    usual = calibrate_from_people(cameras, "front")
    found = calibrate_from_people(cameras, "front", parameters=parameters)
    # Opposite cameras would be 4 cm too near to each other.
    assert errors_of(usual, FRONT, BACK).translation > 0.02
    assert errors_of(found, FRONT, BACK).translation < 0.015


def test_a_prior_holds_what_people_show_less_well() -> None:
    walk = true_movement(14)
    truth = FRONT.world_from_camera.inverse() @ LEFT.world_from_camera
    board = PosePrior(to_pose(rigid(truth.rotation, truth.translation)), 1e-8 * np.eye(6))
    cameras = [watch(FRONT, walk), watch(LEFT, walk)]
    found = calibrate_from_people(cameras, "front", priors={"left": board})
    errors = errors_of(found, FRONT, LEFT)
    assert errors.translation < 0.001
    assert errors.rotation < 0.02
    assert np.sqrt(np.diag(found.cameras["left"].covariance)).max() < 1.5e-4


def test_a_camera_that_sees_people_too_large_is_named() -> None:
    walk = true_movement(15)
    larger = watch(LEFT, walk)
    larger = with_joints(larger, 1.05 * larger.joints)
    found = calibrate_from_people([watch(FRONT, walk), larger], "front")
    assert found.cameras["left"].scale == pytest.approx(1.05, abs=0.004)
    assert "left sees people 4.8 % larger than the other cameras" in found.warnings[1]


def test_the_result_is_a_file_that_capture_reads(tmp_path: Path) -> None:
    walk = true_movement(1)
    found = calibrate_from_people([watch(FRONT, walk), watch(LEFT, walk)], "front")
    calibration = found.rig_calibration(datetime(2026, 1, 2, tzinfo=UTC))
    write_rig_calibration(tmp_path / "rig.toml", calibration)
    assert read_rig_calibration(tmp_path / "rig.toml") == calibration
    assert calibration.cameras["left"].method == "people"
    assert calibration.frame == "z up, x the way front looks, origin on the floor below front"


def _refused(match: str, *cameras, reference: str = "front") -> None:
    with pytest.raises(CalibrationError, match=match):
        calibrate_from_people(cameras, reference)


def test_cameras_that_see_different_people_are_refused() -> None:
    front, left = watch(FRONT, true_movement(16)), watch(LEFT, true_movement(17))
    _refused("left and front do not see the same person move", front, left)


def test_a_camera_whose_images_are_mirrored_is_found_out() -> None:
    walk = true_movement(3)
    seen = watch(LEFT, walk)
    mirrored = with_joints(seen, seen.joints[:, list(MIRRORED_JOINTS)] * [-1.0, 1.0, 1.0])
    _refused("front and left see each other's mirror image", watch(FRONT, walk), mirrored)


def test_a_walk_in_a_circle_is_refused() -> None:
    walk = circling_movement()
    _refused("the walk repeats itself", watch(FRONT, walk), watch(LEFT, walk))


def test_to_and_fro_is_enough_where_clocks_are_nearly_right() -> None:
    walk = pacing_movement()
    nearly = replace(LEFT, offset_s=0.3)
    cameras = [watch(FRONT, walk), watch(nearly, walk)]
    _refused("the walk repeats itself", *cameras)
    found = calibrate_from_people(cameras, "front", clocks_within_s=0.5)
    assert within_aims([errors_of(found, FRONT, nearly)])


def test_a_person_who_stands_still_is_refused() -> None:
    stand = still_movement(18)
    _refused("people stood still", watch(FRONT, stand), watch(LEFT, stand))
    with pytest.raises(CalibrationError, match="moved too little to say how far the clocks"):
        calibrate_from_people(
            [watch(FRONT, stand), watch(LEFT, stand)], "front", clocks_within_s=0.5
        )


def test_too_short_a_walk_is_refused() -> None:
    walk = true_movement(19)
    short = part_of(watch(LEFT, walk), 0.0, 0.3)
    _refused("left saw people for 7 s, and 15 s are needed", watch(FRONT, walk), short)


def test_a_camera_that_sees_nobody_is_named() -> None:
    walk = true_movement(19)
    nobody = watch(LEFT, walk)
    nobody = with_joints(nobody, np.full_like(nobody.joints, np.nan))
    _refused("left followed nobody .* upside down .* rotate = 180", watch(FRONT, walk), nobody)
    none = part_of(nobody, 0.0, 0.0)
    _refused("left followed nobody", watch(FRONT, walk), none)


def test_wrong_cameras_are_refused() -> None:
    front = watch(FRONT, true_movement(19))
    _refused("two cameras or more", front)
    _refused("each once", front, front)
    _refused(
        "the reference side is none of", front, watch(LEFT, true_movement(19)), reference="side"
    )
