"""What several cameras are worth together is measured on the same frames as each alone."""

import numpy as np
import pytest
from inhand_lab.benchmarks.parameters import RigCheckParameters
from inhand_lab.benchmarks.rig_accuracy import RigRun, check_rigs

FEW = RigCheckParameters(frames=16, people=2, learned_frames=60, looks=8)


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
