"""Floors in what a simulated structured-light camera sees of people in furnished rooms."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_lab.geometry.transforms import Transform, rotation_about
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.world.messages import camera_info
from inhand_lab.world.simulation import Casting, simulate_cast
from inhand_outcomes.floor import find_floor


@pytest.mark.long
@pytest.mark.parametrize(
    ("interaction", "participant", "tilt", "roll"),
    [("hammerNail", 0, 0.0, 0.0), ("sweepFloor", 1, 8.0, 15.0), ("shakeVinegar", 1, -6.0, -12.0)],
)
def test_finds_the_floor_within_a_degree_and_2_cm_though_the_camera_is_askew(
    interaction, participant, tilt, roll
):
    cast = Casting(interaction, participant, 6003, people="varied")
    level = simulate_cast(cast, 360, KINECT)
    askew = Transform(np.zeros(3), rotation_about("xz", *np.radians((tilt, roll))))
    simulation = replace(
        level,
        camera_from_world=askew @ level.camera_from_world,
        body_in_camera=level.body_in_camera.seen_from(askew),
        camera_from_object=askew @ level.camera_from_object,
    )
    joints = askew.apply(level.joints_in_camera[5])
    depth = simulation.render(5).depth
    info = camera_info(simulation.intrinsics, simulation.frame_rate)
    floor = find_floor(depth, info, [joints])
    up = simulation.camera_from_world.rotation[:, 2]
    feet = simulation.camera_from_world.translation
    assert floor is not None
    assert np.degrees(np.arccos(np.clip(floor.up @ up, -1.0, 1.0))) < 1.0
    assert floor.up @ feet == pytest.approx(floor.height, abs=0.02)
