"""How far calibrated cameras disagree: a bumped camera and a clock that was set are named."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from inhand_calibration.from_people.calibration import calibrate_from_people
from inhand_calibration.from_people.disagreement import find_disagreement
from inhand_calibration.from_people.skeletons import CameraSkeletons
from inhand_runtime.rig_calibration import RigCalibration
from scipy.spatial.transform import Rotation
from wanderers import BACK, FRONT, LEFT, part_of, true_movement, watch, with_joints

MADE = datetime(2026, 1, 2, tzinfo=UTC)


@pytest.fixture(scope="module")
def calibration() -> RigCalibration:
    walk = true_movement(1)
    cameras = [watch(camera, walk) for camera in (FRONT, LEFT, BACK)]
    return calibrate_from_people(cameras, "front").rig_calibration(MADE)


def _later() -> list[CameraSkeletons]:
    """Half a minute of another day."""
    walk = true_movement(2)
    return [watch(camera, walk, seed=1) for camera in (FRONT, LEFT, BACK)]


def _bumped(seen: CameraSkeletons, degrees: float, aside: float) -> CameraSkeletons:
    turn = Rotation.from_euler("y", degrees, degrees=True).as_matrix()
    return with_joints(seen, seen.joints @ turn.T + [aside, 0.0, 0.0])


def test_cameras_that_nobody_touched_agree(calibration: RigCalibration) -> None:
    found = find_disagreement(_later(), calibration)
    assert len(found.pairs) == 3
    assert all(pair.common_s > 15.0 and pair.moved_m < 0.03 for pair in found.pairs)
    assert found.sentences == ()


def test_half_a_dozen_seconds_are_enough(calibration: RigCalibration) -> None:
    front, left, back = (part_of(seen, 0.3, 0.6) for seen in _later())
    assert find_disagreement([front, left, back], calibration).sentences == ()
    moved = find_disagreement([front, _bumped(left, 0.0, 0.15), back], calibration)
    assert moved.bumped == ("left",)


@pytest.mark.parametrize(("degrees", "aside"), [(4.0, 0.0), (0.0, 0.1), (40.0, 0.5)])
def test_a_bumped_camera_is_named(
    calibration: RigCalibration, degrees: float, aside: float
) -> None:
    front, left, back = _later()
    found = find_disagreement([front, _bumped(left, degrees, aside), back], calibration)
    assert found.bumped == ("left",)
    pair = next(pair for pair in found.pairs if pair.second == "left")
    assert np.degrees(pair.turned_rad) == pytest.approx(degrees, abs=0.6)
    assert not any(pair.clock_changed for pair in found.pairs)
    assert found.sentences[0].startswith("left was moved: people are ")


def test_of_two_cameras_either_may_be_the_bumped_one(calibration: RigCalibration) -> None:
    front, left, _ = _later()
    found = find_disagreement([front, _bumped(left, 5.0, 0.0)], calibration)
    assert found.bumped == ()
    assert found.sentences[0].startswith("one of front and left was moved")


def test_a_clock_that_was_set_is_named(calibration: RigCalibration) -> None:
    front, left, back = _later()
    late = replace(back, times_ns=back.times_ns + 700_000_000)
    found = find_disagreement([front, left, late], calibration)
    assert found.reset == ("back",)
    assert found.bumped == ()
    assert found.pairs[1].clock_s == pytest.approx(-0.7, abs=0.02)
    assert "back has another time: front and back are 0.7" in found.sentences[0]


def test_cameras_that_see_nobody_together_say_nothing(calibration: RigCalibration) -> None:
    front, left, _ = _later()
    nobody = part_of(left, 0.0, 0.0)
    assert find_disagreement([front, nobody], calibration).pairs == ()
    assert (
        find_disagreement([part_of(front, 0, 0.3), part_of(left, 0.6, 1)], calibration).pairs == ()
    )
    assert find_disagreement([front, replace(left, name="new")], calibration).pairs == ()
