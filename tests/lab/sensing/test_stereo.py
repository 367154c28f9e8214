"""What stereo depth alone does."""

from inhand_lab.sensing.cameras import KINECT, OAK_D
from walls import depth_of, wall


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
