"""What moves while the shutter is open is smeared, and nothing else."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_lab.geometry.canvas import Canvas, draw_triangles
from inhand_lab.geometry.surfaces import block, lit
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.sensing.motion_blur import Moving, blurred
from inhand_lab.sensing.render import OBJECT
from inhand_lab.world.simulation import simulate
from inhand_tracker.geometry.arrays import Bytes


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
