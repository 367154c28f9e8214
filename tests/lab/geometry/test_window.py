"""Windows of an image are small cameras that see the same."""

import numpy as np
from inhand_lab.geometry.canvas import Canvas, draw_triangles
from inhand_lab.geometry.surfaces import ellipsoid
from inhand_lab.geometry.window import window_around
from inhand_lab.sensing.cameras import CAMERAS

KINECT = CAMERAS["kinect"].intrinsics
BALL = ellipsoid((0.2, -0.1, 2.0), (0.1, 0.1, 0.1), (200, 0, 0))


def test_a_window_shows_what_the_whole_image_shows_there() -> None:
    window = window_around(KINECT, BALL.vertices)
    vertices = BALL.vertices.astype(np.float32)
    whole, small = Canvas.blank(KINECT), Canvas.blank(window.intrinsics)
    for canvas, intrinsics in ((whole, KINECT), (small, window.intrinsics)):
        draw_triangles(canvas, intrinsics, vertices, BALL.faces, BALL.colours, 1)
    assert np.count_nonzero(whole.labels) == np.count_nonzero(window.cut(whole).labels) > 1000
    assert np.mean(window.cut(whole).labels != small.labels) < 0.001


def test_a_window_is_empty_where_nothing_is_seen_and_whole_where_a_point_is_too_near() -> None:
    aside = window_around(KINECT, BALL.vertices + np.array([9.0, 0.0, 0.0]))
    assert 0 in (aside.intrinsics.width, aside.intrinsics.height)
    near = window_around(KINECT, BALL.vertices - np.array([0.0, 0.0, 2.0]))
    assert near.intrinsics == KINECT
