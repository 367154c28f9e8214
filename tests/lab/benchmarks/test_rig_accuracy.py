"""What several cameras are worth together is measured on the same frames as each alone."""

import numpy as np
import pytest
from inhand_lab.benchmarks.parameters import RigCheckParameters
from inhand_lab.benchmarks.rig_accuracy import RigRun, check_rigs

FEW = RigCheckParameters(frames=16, people=2, learned_frames=60, looks=8)


@pytest.mark.long
def test_a_rig_s_error_stands_beside_each_camera_s_and_one_camera_fails() -> None:
    """Only here are a simulated rig's frames tracked by its cameras, alone and together."""
    done: list[None] = []
    run = RigRun("drinkFromMug", 6001, 2, roaming=False, parameters=FEW)
    (check,) = check_rigs([run], 1, lambda: done.append(None))
    assert list(check.single_m) == ["front", "left"]
    assert check.killed == "left"
    assert check.frames == 15
    assert check.without_pose == check.killed_without_pose == 0
    assert check.best_m <= check.mean_m
    assert 0.0 < check.fused_m < 1.1 * check.mean_m
    assert check.jump_m < 0.05
    assert np.isfinite([check.killed_m, check.usual_jump_m, check.region_share]).all()
    assert check.fused_ms > check.single_ms > 0.0
    assert len(done) == 1
