"""What the simulated cameras make of perfect frames."""

import time
from dataclasses import replace

import numpy as np
import pytest
from inhand_lab.geometry.canvas import Canvas, draw_triangles
from inhand_lab.geometry.surfaces import block, lit
from inhand_lab.objects.model import RETURN_NO_DEPTH
from inhand_lab.sensing.cameras import CAMERAS, KINECT, OAK_D, Camera
from inhand_lab.sensing.motion_blur import Moving, blurred
from inhand_lab.sensing.render import OBJECT, ROOM
from inhand_lab.sensing.sensor import FrameConditions, brightness, sense
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.simulation import simulate
from inhand_tracker.geometry.arrays import Array, Bytes

EVERY_CAMERA = pytest.mark.parametrize("camera", CAMERAS.values(), ids=lambda one: one.name)


def wall(distance: float, camera: Camera) -> Canvas:
    """Grey, with enough of a pattern to be matched."""
    canvas = Canvas.blank(camera.intrinsics)
    canvas.inverse_depth[:] = 1.0 / distance
    canvas.labels[:] = ROOM
    canvas.colour[:] = 118 + 4 * (np.arange(camera.intrinsics.width) % 2)[:, None]
    return canvas


def depth_of(canvas: Canvas, camera: Camera, seed: int = 0, unseen: int = 0) -> Array:
    random = np.random.default_rng(seed)
    return sense(canvas, camera, random, FrameConditions(unseen=unseen))[1].astype(float)


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


def test_the_kinects_steps_are_eighths_of_a_pixel() -> None:
    steps = [
        np.diff(np.unique(depth_of(wall(distance, KINECT), KINECT))[1:]).max()
        for distance in (1.0, 2.0, 4.0)
    ]
    assert steps == pytest.approx([3.0, 12.0, 46.0], rel=0.2)


def test_most_of_the_kinects_noise_stands_still_and_most_of_the_stereos_does_not() -> None:
    changed = {}
    for camera in (KINECT, OAK_D):
        first, second = (depth_of(wall(2.7, camera), camera, seed) for seed in (0, 1))
        changed[camera.name] = np.mean((first != second)[(first > 0) & (second > 0)])
    assert 0.05 < changed["kinect"] < 0.35
    assert changed["oak_d"] > 0.4


def test_the_projector_leaves_a_shadow_to_the_left_of_a_near_thing() -> None:
    canvas = wall(4.0, KINECT)
    canvas.inverse_depth[200:280, 300:340] = 1.0 / 1.5
    depth = depth_of(canvas, KINECT)
    width = 525 * 0.075 * (1 / 1.5 - 1 / 4.0)
    assert (depth[210:270, 303 - int(width) : 298] == 0).mean() > 0.9
    assert (depth[210:270, 345:360] == 0).mean() < 0.05


def test_two_cameras_see_neither_side_of_a_near_thing() -> None:
    canvas = wall(4.0, OAK_D)
    canvas.inverse_depth[300:400, 600:700] = 1.0 / 1.5
    depth = depth_of(canvas, OAK_D)
    width = int(0.5 * 1000 * 0.075 * (1 / 1.5 - 1 / 4.0))
    assert (depth[310:390, 602 - width : 597] == 0).mean() > 0.8
    assert (depth[310:390, 703 : 698 + width] == 0).mean() > 0.8
    assert (depth[310:390, 740:780] == 0).mean() < 0.05


def test_stereo_has_holes_where_nothing_is_drawn() -> None:
    bare = wall(2.0, OAK_D)
    bare.colour[:] = 120
    assert 0.1 < (depth_of(bare, OAK_D) == 0).mean() < 0.4
    assert (depth_of(wall(2.0, OAK_D), OAK_D) == 0).mean() < 0.01
    assert (depth_of(wall(2.0, KINECT), KINECT) == 0).mean() < 0.01


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


def test_eight_objects_return_nothing() -> None:
    assert len(RETURN_NO_DEPTH) == 8
    for interaction in INTERACTIONS.values():
        model = interaction.object_model()
        assert model.returns_depth == (model.name not in RETURN_NO_DEPTH)


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


def drawn_and_blurred(pixels: float) -> tuple[Bytes, Bytes]:
    """A white block before black, still and as it moves by some pixels to the right."""
    surface = block((0.0, 0.0, 2.1), (0.2, 0.2, 0.2), (200, 200, 200))
    room = Canvas.blank(KINECT.intrinsics)
    sharp = room.copy()
    draw_triangles(
        sharp,
        KINECT.intrinsics,
        surface.vertices.astype(np.float32),
        surface.faces,
        lit(surface.normals, surface.colours),
        OBJECT,
    )
    travel = np.zeros_like(surface.vertices)
    travel[:, 0] = pixels * 2.0 / KINECT.intrinsics.fx
    return sharp.colour, blurred(sharp, room, KINECT.intrinsics, [Moving(surface, travel)])


def test_what_moves_is_smeared_along_its_way() -> None:
    sharp, smeared = drawn_and_blurred(pixels=24.0)
    assert smeared.mean() == pytest.approx(sharp.mean(), rel=0.02)
    assert np.count_nonzero(smeared[240]) - np.count_nonzero(sharp[240]) > 3 * 16
    steepest = np.abs(np.diff(smeared[240, :, 0].astype(int))).max()
    assert steepest < 0.3 * np.abs(np.diff(sharp[240, :, 0].astype(int))).max()
    assert np.array_equal(sharp[:, 320], smeared[:, 320])


def test_what_rests_is_sharp() -> None:
    sharp, still = drawn_and_blurred(pixels=0.4)
    assert still is sharp


def test_a_fast_broom_is_blurred_and_depth_is_not() -> None:
    simulation = simulate("sweepFloor", 0, seed=3)
    way = np.linalg.norm(np.diff(simulation.translations, axis=0), axis=1)
    frame = int(way.argmax())
    quick = replace(simulation, camera=replace(KINECT, exposure=1e-6))
    blurry, crisp = simulation.render(frame), quick.render(frame)
    assert np.array_equal(blurry.depth, crisp.depth)
    assert np.abs(blurry.colour.astype(int) - crisp.colour).max() > 40


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
