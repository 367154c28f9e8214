"""What a Kinect's depth alone does."""

import numpy as np
import pytest
from inhand_lab.sensing.cameras import KINECT
from walls import depth_of, wall


def test_the_kinects_steps_are_eighths_of_a_pixel() -> None:
    steps = [
        np.diff(np.unique(depth_of(wall(distance, KINECT), KINECT))[1:]).max()
        for distance in (1.0, 2.0, 4.0)
    ]
    assert steps == pytest.approx([3.0, 12.0, 46.0], rel=0.2)


def test_the_projector_leaves_a_shadow_to_the_left_of_a_near_thing() -> None:
    canvas = wall(4.0, KINECT)
    canvas.inverse_depth[200:280, 300:340] = 1.0 / 1.5
    depth = depth_of(canvas, KINECT)
    width = 525 * 0.075 * (1 / 1.5 - 1 / 4.0)
    assert (depth[210:270, 303 - int(width) : 298] == 0).mean() > 0.9
    assert (depth[210:270, 345:360] == 0).mean() < 0.05
