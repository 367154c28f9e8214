"""Rigs of simulated cameras are tracked together, however cameras hang."""

from dataclasses import replace

import numpy as np
import pytest
from fetched_weights import use_weights
from inhand_capture.estimation.estimator import SkeletonEstimator
from inhand_capture.estimation.networks import open_network
from inhand_lab.benchmarks.estimated_skeletons import joints_of
from inhand_lab.benchmarks.rig_models import learn_model
from inhand_lab.benchmarks.rig_tracking import track_rig
from inhand_lab.world.messages import camera_info
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


def test_the_network_finds_people_in_a_picture_that_is_upside_down(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    use_weights(monkeypatch, "full")
    seen = simulate_rig(INTERACTION, 0, SEED, 3, 2, upside_down=("left",)).cameras[1]
    estimator = SkeletonEstimator(open_network("full"), camera_info(seen.intrinsics, 30.0))
    for frame in range(2):
        picture = seen.render(frame)
        (person,) = estimator.estimate(picture.colour, picture.depth, frame * 33_000_000)
        off = np.linalg.norm(joints_of(person) - seen.true_joints_in_camera[frame], axis=1)
        assert np.nanmedian(off) < 0.08
