"""Rigs of simulated cameras are tracked together, however cameras hang."""

from dataclasses import replace

import pytest
from inhand_lab.benchmarks.rig_models import learn_model
from inhand_lab.benchmarks.rig_tracking import track_rig
from inhand_lab.world.rigs import RigSimulation, simulate_rig
from inhand_lab.world.simulation import simulate

INTERACTION, SEED, FRAMES = "answerPhone", 6003, 20


@pytest.mark.long
def test_a_camera_upside_down_that_follows_nobody_adds_what_its_image_shows() -> None:
    model = learn_model([simulate(INTERACTION, person, SEED, 60) for person in (1, 2)], looks=8)
    rig = simulate_rig(INTERACTION, 0, SEED, FRAMES, 2, upside_down=("left",))
    errors = track_rig(rig, model)
    assert errors.fused.without_pose == 0
    assert errors.single["left"].without_pose == FRAMES - 1
    assert errors.fused.mean_m < 0.7 * errors.single["front"].mean_m
    front, left = rig.views
    upright = simulate_rig(INTERACTION, 0, SEED, FRAMES, 2).views[1].rig_from_camera
    believed_upright = RigSimulation((front, replace(left, rig_from_camera=upright)))
    assert track_rig(believed_upright, model, singles=False).fused.mean_m > errors.fused.mean_m
