"""A rig's calibration by a board: its frame, its deviations, what is wrong, and what was moved."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from board_rigs import WALK, SeenBoard, seen_board, three_cameras
from inhand_calibration.errors import CalibrationError
from inhand_calibration.from_board.calibration import (
    BoardCalibration,
    calibrate_from_board,
    scaled,
)
from inhand_calibration.from_board.disagreement import bumped, find_board_disagreement
from inhand_calibration.rigid import inverse, moved, of_pose, rigid, to_pose, turned_by

MADE = datetime(2026, 11, 30, tzinfo=UTC)
pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def seen() -> SeenBoard:
    """Two cameras that see a board, which lies on the floor at last."""
    return seen_board(21, replace(WALK, on_floor=True), cameras=three_cameras(0.6)[:2])


@pytest.fixture(scope="module")
def on_floor(seen: SeenBoard) -> BoardCalibration:
    return calibrate_from_board(seen.sights, MADE, board_on_floor=True)


def heights(seen: SeenBoard, calibration: BoardCalibration) -> list[tuple[float, float]]:
    """How high each camera is said to be, and how high it is."""
    by_name = {camera.name: camera for camera in seen.cameras}
    return [
        (one.rig_from_camera.translation[2], float(by_name[name].room_from_camera[2, 3]))
        for name, one in calibration.rig.cameras.items()
    ]


def test_a_board_that_lies_on_the_floor_at_last_says_where_up_is(
    seen: SeenBoard, on_floor: BoardCalibration
) -> None:
    assert on_floor.frame.z_is_up
    assert "board on the floor" in on_floor.rig.frame
    for said, true in heights(seen, on_floor):
        assert said == pytest.approx(true, abs=0.01)


def test_a_board_that_was_lower_before_does_not_lie_on_the_floor() -> None:
    held = seen_board(24, replace(WALK, holds=8), cameras=three_cameras()[:2])
    with pytest.raises(CalibrationError, match=r"lower before|cannot lie on the floor"):
        calibrate_from_board(held.sights, MADE, board_on_floor=True)


def test_the_floor_is_found_in_depth_and_the_origin_is_below_the_reference(
    seen: SeenBoard,
) -> None:
    random = np.random.default_rng(1)
    floor = np.column_stack([random.uniform(-2, 2, (1500, 2)), np.zeros(1500)])
    wall = np.column_stack([np.full(500, -2.0), random.uniform(0, 2, (500, 2))])
    room = np.concatenate([floor, wall])
    points = {
        camera.name: moved(inverse(camera.room_from_camera), room)
        + 0.005 * random.standard_normal(room.shape)
        for camera in seen.cameras
    }
    calibration = calibrate_from_board(seen.sights, MADE, points)
    assert calibration.frame.z_is_up
    assert "on the floor below front" in calibration.rig.frame
    for said, true in heights(seen, calibration):
        assert said == pytest.approx(true, abs=0.01)
    front = calibration.rig.cameras["front"].rig_from_camera
    assert front.translation[:2] == pytest.approx([0.0, 0.0], abs=1e-9)


def test_the_origin_is_the_camera_that_is_named_which_is_sure_of_itself(seen: SeenBoard) -> None:
    calibration = calibrate_from_board(seen.sights, MADE, origin="left")
    left, front = (calibration.rig.cameras[name] for name in ("left", "front"))
    assert left.rig_from_camera.translation == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
    assert left.rotation_deviation == (0.0, 0.0, 0.0)
    assert 0.0 < max(front.translation_deviation) < 0.005
    assert front.clock_offset_ns == pytest.approx(2e9, abs=4e6)


def test_a_board_printed_smaller_makes_a_smaller_rig(
    seen: SeenBoard, on_floor: BoardCalibration
) -> None:
    small = calibrate_from_board(scaled(seen.sights, 0.97), MADE, board_on_floor=True)
    for name, one in small.rig.cameras.items():
        large = on_floor.rig.cameras[name].rig_from_camera.translation
        assert one.rig_from_camera.translation == pytest.approx(0.97 * np.array(large), abs=0.003)


def test_the_origin_may_be_the_board_where_it_stood_still_at_last(seen: SeenBoard) -> None:
    calibration = calibrate_from_board(seen.sights, MADE, origin="board")
    assert not calibration.frame.z_is_up
    assert "z out of its face" in calibration.rig.frame


def test_wrong_intrinsics_are_said_with_the_numbers_to_use(seen: SeenBoard) -> None:
    lens = seen.sights[1].lens
    wrong = seen.with_lens(1, replace(lens, fx=1.03 * lens.fx, fy=1.03 * lens.fy))
    calibration = calibrate_from_board(wrong.sights, MADE)
    (finding,) = calibration.lenses
    assert finding.camera == "left"
    assert lens.fx * 1.03 * (1.0 + finding.focal_share) == pytest.approx(lens.fx, rel=0.006)
    assert finding.sentence in calibration.warnings
    assert "the intrinsics of left are wrong: with fx = " in finding.sentence


def test_a_camera_that_was_bumped_is_named_and_others_agree() -> None:
    before = seen_board(22)
    calibration = calibrate_from_board(before.sights, MADE).rig
    left = calibration.cameras["left"]
    turn = turned_by(np.array([0.0, np.radians(0.8), 0.0]))
    pose = of_pose(left.rig_from_camera) @ rigid(turn, np.array([0.012, 0.0, 0.0]))
    elsewhere = {**calibration.cameras, "left": replace(left, rig_from_camera=to_pose(pose))}
    pairs = find_board_disagreement(before.sights, replace(calibration, cameras=elsewhere))
    assert bumped(pairs) == ("left",)
    (others,) = [pair for pair in pairs if "left" not in (pair.first, pair.second)]
    assert not others.moved
    assert others.moved_m < 0.003
    assert not any(pair.clock_changed for pair in pairs)


def test_a_camera_that_never_saw_the_board_is_named(seen: SeenBoard) -> None:
    blind = seen.with_sights(1, ())
    with pytest.raises(CalibrationError, match="left never saw the board"):
        calibrate_from_board(blind.sights, MADE)
    with pytest.raises(CalibrationError, match="there is no camera attic"):
        calibrate_from_board(seen.sights, MADE, origin="attic")
