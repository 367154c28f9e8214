"""What the simulated cameras make of perfect frames."""

import time

import numpy as np
import pytest
from inhand_lab.sensing.cameras import CAMERAS, KINECT, OAK_D, Camera
from inhand_lab.sensing.render import OBJECT
from inhand_lab.sensing.sensor import FrameConditions, brightness, sense
from inhand_lab.world.simulation import simulate
from walls import depth_of, wall

EVERY_CAMERA = pytest.mark.parametrize("camera", CAMERAS.values(), ids=lambda one: one.name)


@EVERY_CAMERA
def test_depth_steps_and_noise_grow_with_the_distance(camera: Camera) -> None:
    deviations, steps = [], []
    for distance in (1.0, 2.0, 4.0):
        depth = depth_of(wall(distance, camera), camera)
        measured = depth[depth > 0]
        assert measured.mean() == pytest.approx(1000 * distance, rel=0.01)
        deviations.append(measured.std())
        steps.append(np.diff(np.unique(measured)).max())
    assert deviations[0] < 0.4 * deviations[1] < 0.16 * deviations[2]
    assert steps[1] == pytest.approx(4 * steps[0], rel=0.35)
    assert steps[2] == pytest.approx(4 * steps[1], rel=0.35)


def test_most_of_the_kinects_noise_stands_still_and_most_of_the_stereos_does_not() -> None:
    changed = {}
    for camera in (KINECT, OAK_D):
        first, second = (depth_of(wall(2.7, camera), camera, seed) for seed in (0, 1))
        changed[camera.name] = np.mean((first != second)[(first > 0) & (second > 0)])
    assert 0.05 < changed["kinect"] < 0.35
    assert changed["oak_d"] > 0.4


@EVERY_CAMERA
@pytest.mark.parametrize("distance", [0.3, 15.0])
def test_nothing_is_measured_beyond_the_range(camera: Camera, distance: float) -> None:
    assert not depth_of(wall(distance, camera), camera).any()


@EVERY_CAMERA
def test_what_returns_nothing_is_a_hole(camera: Camera) -> None:
    canvas = wall(2.0, camera)
    canvas.labels[100:200, 100:200] = OBJECT
    depth = depth_of(canvas, camera, unseen=OBJECT)
    assert not depth[105:195, 105:195].any()
    assert (depth[220:, 220:] > 0).all()


def test_colour_noise_has_no_bias() -> None:
    canvas = wall(2.0, KINECT)
    canvas.colour[:] = 120
    colour, _ = sense(canvas, KINECT, np.random.default_rng(0))
    assert colour.mean() == pytest.approx(120.0, abs=0.2)
    assert 3.0 < colour.std() < 7.0


def test_brightness_changes_slowly_and_by_little() -> None:
    gains = brightness(np.arange(3000) / 30.0, np.random.default_rng(0))
    assert np.abs(np.log(gains)).max() < 0.3
    assert 0.02 < np.log(gains).std() < 0.10
    assert np.abs(np.diff(gains, axis=0)).mean() < 0.02
    conditions = FrameConditions(gains=np.full(3, 1.1))
    bright, _ = sense(wall(2.0, KINECT), KINECT, np.random.default_rng(0), conditions)
    assert bright.mean() == pytest.approx(1.1 * 120.0, abs=0.5)


@EVERY_CAMERA
def test_the_whole_person_fits_into_every_camera(camera: Camera) -> None:
    for participant in range(4):
        simulation = simulate("putOnGlasses", participant, seed=9, frames=90, camera=camera)
        lens = camera.intrinsics
        joints = simulation.true_joints_in_camera.reshape(-1, 3)
        pixels = joints[:, :2] / joints[:, 2:] * (lens.fx, lens.fy) + (lens.cx, lens.cy)
        assert pixels.min() > 10.0
        assert (pixels.max(axis=0) < (lens.width - 10.0, lens.height - 10.0)).all()
        seen = simulation.render(40)
        assert seen.colour.shape == (lens.height, lens.width, 3)
        assert seen.depth.shape == (lens.height, lens.width)


@pytest.mark.long
@pytest.mark.parametrize(("camera", "limit_ms"), [(KINECT, 33.0), (OAK_D, 66.0)])
def test_a_frame_costs_less_than_its_time(camera: Camera, limit_ms: float) -> None:
    simulation = simulate("sweepFloor", 1, seed=5, camera=camera)
    simulation.prepare()
    begin = time.process_time()
    for frame in range(60, 120):
        simulation.render(frame)
    assert 1000.0 * (time.process_time() - begin) / 60 < limit_ms
