"""What is drawn into a tab's scene, which is in the camera frame: objects, people, points."""

import numpy as np
import viser
from inhand_tracker.body.skeleton import CHILD_JOINTS, PARENT_JOINTS
from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.shape.shape import ObjectShape

Colour = tuple[int, int, int]

BONE_PIXELS = 3.0
"""Thickness of a bone on the screen."""
BONE: Colour = (255, 210, 60)
TRUE: Colour = (60, 220, 90)
TRACKED: Colour = (250, 70, 60)
UPRIGHT = np.array([np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0])
"""A rotation with z up, as objects stand: to -y, for the scene's y points down."""


def add_object(
    scene: viser.SceneApi, name: str, shape: ObjectShape, colour: Colour, opacity: float = 0.7
) -> viser.MeshHandle:
    """Draw an object; its handle's ``position`` and ``wxyz`` are the pose in the camera frame."""
    return scene.add_mesh_simple(
        name,
        shape.vertices.astype(np.float32),
        shape.faces.astype(np.uint32),
        color=colour,
        opacity=opacity,
        side="double",
    )


def bones(joints: Array) -> Singles:
    """Return the ends (B, 2, 3) of the parts of joints (20, 3) whose both ends are there."""
    ends = np.stack((joints[PARENT_JOINTS], joints[CHILD_JOINTS]), axis=1)
    whole = np.isfinite(ends).all(axis=(1, 2))
    return np.asarray(ends[whole], np.float32)


def add_bones(
    scene: viser.SceneApi, name: str, ends: Singles, colour: Colour
) -> viser.LineSegmentsHandle:
    """Draw lines between ends (B, 2, 3)."""
    return scene.add_line_segments(
        name, ends, colour, thickness=BONE_PIXELS, thickness_units="screen"
    )


def add_points(
    scene: viser.SceneApi, name: str, points: Singles, colours: Bytes, size: float = 0.004
) -> viser.PointCloudHandle:
    """Draw points (N, 3) in the camera frame with their colours (N, 3) RGB."""
    return scene.add_point_cloud(
        name, points, colours, point_size=size, point_shape="square", precision="float32"
    )


def points_of(
    depth: Singles, colour: Bytes | None, camera: Intrinsics, step: int
) -> tuple[Singles, Bytes]:
    """Return the points (N, 3) of a depth image (H, W) in metres, and their colours (N, 3).

    They are those of one pixel in ``step``, along rows and columns, where anything was measured.
    ``camera`` took the image, and ``colour`` (h, w, 3), RGB of the same view, of any size.
    """
    rows, columns = step * np.array(np.nonzero(depth[::step, ::step]))
    pixels = np.column_stack((columns, rows)).astype(float)
    of_depth = camera.scaled_to(depth.shape[1], depth.shape[0])
    points = of_depth.unproject(pixels, depth[rows, columns].astype(float))
    if colour is None:
        return points.astype(np.float32), np.full(points.shape, 128, np.uint8)
    height, width = colour.shape[:2]
    of_colour = (rows * height // depth.shape[0], columns * width // depth.shape[1])
    return points.astype(np.float32), colour[of_colour]
