"""Cameras placed by a simulated person who walks about."""

from inhand_lab.benchmarks.parameters import PeopleCalibrationCheckParameters
from inhand_lab.benchmarks.people_calibration import measure_people_calibration, summed_up

QUICK = PeopleCalibrationCheckParameters(
    seeds=(1,), seconds=20.0, around_deg=((-15.0, 15.0), (60.0, 120.0)), frame_rates=(15.0, 15.0)
)


def test_a_rig_is_placed_within_a_few_centimetres_by_twenty_seconds() -> None:
    (rig,) = measure_people_calibration(QUICK)
    (camera,) = rig.cameras
    assert camera.name == "camera1"
    assert camera.translation_mm < 40.0
    assert camera.rotation_deg < 0.7
    assert camera.clock_ms < 8.0
    assert camera.translation_deviation_mm > 1.0
    assert camera.consistency < 8.0
    assert rig.floor_mm is not None
    assert rig.floor_mm < 60.0
    summary = summed_up([rig], QUICK)
    assert summary.cameras == 1
    assert summary.worst_translation_mm == summary.translation_mm == camera.translation_mm
