"""What several cameras are worth together is measured on the same frames as each alone."""

import numpy as np
import pytest
from inhand_lab.benchmarks.parameters import RigCheckParameters
from inhand_lab.benchmarks.rig_accuracy import RigRun, check_rigs
from inhand_lab.benchmarks.rig_tracking import NOT_OFF, places_of
from inhand_lab.world.rigs import simulate_rig
from inhand_tracker.geometry import rotations
from inhand_tracker.rig.placing import PlaceDeviation

OFF = PlaceDeviation(0.01, 0.02)
FEW = RigCheckParameters(frames=16, people=2, learned_frames=60, looks=8)


def test_cameras_are_elsewhere_than_they_are_said_to_be_by_as_much_as_was_asked_for() -> None:
    rig = simulate_rig("drinkFromMug", 0, 6001, 2, 4)
    true, said = places_of(rig, NOT_OFF), places_of(rig, OFF)
    off = np.array([said[name].translation - true[name].translation for name in rig.names])
    turns = [rotations.angle_between(said[name].rotation, true[name].rotation) for name in said]
    assert list(said) == list(rig.names)
    assert 0.005 < np.sqrt(np.mean(off**2)) < 0.015
    assert 0.01 < np.sqrt(np.mean(np.square(turns)) / 3.0) < 0.03


@pytest.mark.long
@pytest.mark.exhaustive
def test_a_rig_s_error_stands_beside_each_camera_s_and_one_camera_fails() -> None:
    """Only here are a simulated rig's frames tracked by its cameras, alone and together."""
    done: list[None] = []
    run = RigRun("drinkFromMug", 6001, 2, roaming=False, parameters=FEW)
    (check,) = check_rigs([run], 1, lambda: done.append(None))
    assert list(check.single_m) == ["front", "left"]
    assert check.killed == "left"
    assert check.frames == 15
    assert check.without_pose == 0
    # The camera that is left loses a frame now and then.
    assert check.killed_without_pose < 5
    assert 0.0 < check.fused_m < check.mean_m
    assert np.isfinite([check.killed_m, check.jump_m, check.usual_jump_m]).all()
    assert 0.0 <= check.region_share <= 1.0
    assert check.fused_ms > check.single_ms > 0.0
    assert len(done) == 1
