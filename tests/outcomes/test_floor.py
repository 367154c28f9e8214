"""Floors in depth images drawn by formula: rays cut planes."""

import numpy as np
import pytest
from inhand_outcomes.floor import Floor, find_floor, together
from inhand_schemas.joints import Joint
from inhand_schemas.messages import CameraInfo, Pose
from scipy.spatial.transform import Rotation

WIDTH, HEIGHT, FOCAL = 320, 240, 262.5
INFO = CameraInfo(
    sequence=0, time_ns=0, width=WIDTH, height=HEIGHT, fx=FOCAL, fy=FOCAL, cx=159.5, cy=119.5
)
CAMERA_HEIGHT = 1.3


def camera_axes(tilt_deg, roll_deg):
    """The room's axes in a camera that is tilted down and rolled: columns right, ahead, up."""
    level = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    return Rotation.from_euler("xz", [tilt_deg, roll_deg], degrees=True).as_matrix() @ level


def depth_of(axes, boxes, *, noise=True, floor=True):
    """Depth of a floor CAMERA_HEIGHT below, a wall 3.4 m ahead, and boxes (low, high) (2, 3)."""
    v, u = np.mgrid[0:HEIGHT, 0:WIDTH]
    rays = np.stack([(u - 159.5) / FOCAL, (v - 119.5) / FOCAL, np.ones(u.shape)], axis=-1)
    ways = rays @ axes  # in the room, the camera at (0, 0, 0)
    ways = np.where(np.abs(ways) < 1e-9, 1e-9, ways)
    along = np.full(u.shape, 9.0)
    if floor:
        along = np.where(ways[..., 2] < 0.0, -CAMERA_HEIGHT / ways[..., 2], along)
    along = np.minimum(along, np.where(ways[..., 1] > 0.0, 3.4 / ways[..., 1], 9.0))
    for low, high in boxes:
        bounds = np.sort(np.array([low / ways, high / ways]), axis=0)
        enters, leaves = bounds[0].max(axis=-1), bounds[1].min(axis=-1)
        hit = (enters < leaves) & (enters > 0.0)
        along = np.where(hit, np.minimum(along, enters), along)
    random = np.random.default_rng(1)
    if noise:
        along = along + (0.002 + 0.0025 * along**2) * random.normal(size=along.shape)
    return np.clip(np.rint(1000.0 * along), 0, 65535).astype(np.uint16)


def standing(axes, ahead=2.4, sink=0.0):
    """Joints of somebody 1.7 m tall whose soles are ``sink`` below the floor."""
    joints = np.full((20, 3), np.nan)
    for joint, height in (
        (Joint.HIP_CENTER, 0.97),
        (Joint.SHOULDER_CENTER, 1.42),
        (Joint.ANKLE_LEFT, 0.07),
        (Joint.ANKLE_RIGHT, 0.07),
    ):
        joints[joint] = axes @ [0.0, ahead, height - CAMERA_HEIGHT - sink]
    return joints


def angle_deg(one, other):
    return np.degrees(np.arccos(np.clip(one @ other, -1.0, 1.0)))


TABLE = (np.array([-0.7, 1.5, -0.60]), np.array([0.7, 2.3, -0.56]))


@pytest.mark.parametrize(("tilt", "roll"), [(0.0, 0.0), (15.0, 0.0), (25.0, -18.0), (5.0, 20.0)])
def test_finds_the_floor_beside_a_table_and_a_wall_however_the_camera_is_held(tilt, roll):
    axes = camera_axes(tilt, roll)
    floor = find_floor(depth_of(axes, [TABLE]), INFO, [standing(axes)])
    assert floor is not None
    assert angle_deg(floor.up, axes[:, 2]) < min(1.0, 3.0 * floor.up_deviation_deg)
    assert floor.height == pytest.approx(-CAMERA_HEIGHT, abs=0.02)


def test_a_table_that_hides_the_floor_is_not_taken_for_it():
    axes = camera_axes(15.0, 0.0)
    wide = (np.array([-3.0, 0.8, -0.60]), np.array([3.0, 3.3, -0.56]))
    hidden = depth_of(axes, [wide])
    assert find_floor(hidden, INFO, [standing(axes)]) is None
    assert find_floor(depth_of(axes, []), INFO, [standing(axes, sink=0.5)]) is None


def test_a_small_level_plane_is_nothing_where_nobody_is_seen():
    axes = camera_axes(20.0, 0.0)
    shelf = (np.array([-0.6, 1.2, -0.50]), np.array([0.6, 2.2, -0.46]))
    only_shelf = depth_of(axes, [shelf], floor=False)
    assert find_floor(only_shelf, INFO) is None
    assert find_floor(depth_of(axes, []), INFO) is not None


def test_a_wall_is_not_taken_for_the_floor():
    assert find_floor(depth_of(camera_axes(10.0, 0.0), [], floor=False), INFO) is None
    assert find_floor(np.zeros((HEIGHT, WIDTH), np.uint16), INFO) is None


def test_a_floor_in_a_moved_camera_is_the_same_plane_of_the_rig():
    axes = camera_axes(15.0, 10.0)
    floor = Floor(axes[:, 2], -CAMERA_HEIGHT, 0.3, 0.01)
    turn = Rotation.from_euler("yx", [40.0, 20.0], degrees=True)
    pose = Pose((0.3, -0.2, 0.5), tuple(turn.as_quat(scalar_first=True).tolist()))
    moved = floor.in_rig(pose)
    on_floor = axes @ [0.7, 2.0, -CAMERA_HEIGHT]
    in_rig = turn.apply(on_floor) + np.array([0.3, -0.2, 0.5])
    assert moved.up @ in_rig == pytest.approx(moved.height)


def test_several_floors_are_one_unless_they_disagree():
    up = np.array([0.0, -1.0, 0.0])
    alike = [Floor(up, -1.3 + shift, 0.3, 0.01) for shift in (-0.005, 0.0, 0.004, 0.6)]
    one = together(alike)
    assert one is not None
    assert one.height == pytest.approx(-1.298, abs=0.003)
    assert together([Floor(up, height, 0.3, 0.01) for height in (-1.3, -1.0, -0.7, -0.4)]) is None
    assert together([]) is None
