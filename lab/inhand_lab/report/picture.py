"""Draws the skeleton and objects on a camera's image."""

from dataclasses import dataclass

import cv2
import numpy as np
from inhand_schemas.messages import Pose
from inhand_tracker.body.skeleton import CHILD_JOINTS, PARENT_JOINTS
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Bytes
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.shape.shape import ObjectShape

from inhand_lab.report.parameters import DEFAULT_REPORT

Colour = tuple[int, int, int]

BONE: Colour = (255, 210, 60)
TRUE: Colour = (60, 220, 90)
TRACKED: Colour = (250, 70, 60)
WHITE: Colour = (255, 255, 255)


@dataclass(frozen=True)
class Picture:
    """An RGB image (H, W, 3) to draw on, in a camera's view."""

    pixels: Bytes
    camera: Intrinsics

    def draw_skeleton(self, joints: Array) -> None:
        """Draw the 19 parts of joints (20, 3) in the camera frame, but for missing ones."""
        points = self.camera.project(joints)
        for parent, child in zip(points[PARENT_JOINTS], points[CHILD_JOINTS], strict=True):
            if np.isfinite(parent).all() and np.isfinite(child).all():
                cv2.line(self.pixels, _pixel(parent), _pixel(child), BONE, 2, cv2.LINE_AA)

    def draw_object(self, shape: ObjectShape, pose: Pose, colour: Colour) -> None:
        """Draw the sharp edges and the outline of an object at camera_from_object."""
        placed = rotations.rotate(np.array(pose.rotation), shape.vertices) + pose.translation
        points = self.camera.project(placed)
        for first, second in _sharp_edges(shape, placed):
            if np.isfinite(points[[first, second]]).all():
                cv2.line(
                    self.pixels,
                    _pixel(points[first]),
                    _pixel(points[second]),
                    colour,
                    1,
                    cv2.LINE_AA,
                )

    def write(self, text: str, line: int, colour: Colour) -> None:
        """Write a line of text at the top left."""
        place = (12, 30 + 28 * line)
        for thickness, ink in ((4, (0, 0, 0)), (2, colour)):
            cv2.putText(
                self.pixels, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.8, ink, thickness, cv2.LINE_AA
            )


def picture_of(colour: Bytes, camera: Intrinsics) -> Picture:
    """Copy an image, enlarged, to draw on."""
    height, width = colour.shape[:2]
    size = (DEFAULT_REPORT.enlargement * width, DEFAULT_REPORT.enlargement * height)
    enlarged = cv2.resize(colour, size, interpolation=cv2.INTER_CUBIC)
    return Picture(np.asarray(enlarged, np.uint8), camera.scaled_to(*size))


def _sharp_edges(shape: ObjectShape, placed: Array) -> Array:
    """Return pairs of vertices (E, 2): the outline seen from the camera, and sharp edges."""
    corners = placed[shape.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = np.einsum("fi,fi->f", normals, corners[:, 0]) < 0.0
    unit = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    edges = np.sort(shape.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(shape.faces)), 3)
    order = np.lexsort(edges.T)
    edges, owner = edges[order], owner[order]
    shared = (edges[1:] == edges[:-1]).all(axis=1)
    first, second = owner[:-1][shared], owner[1:][shared]
    sharp = np.einsum("ei,ei->e", unit[first], unit[second]) < np.cos(
        np.radians(DEFAULT_REPORT.sharp_edge_deg)
    )
    shown = (facing[first] != facing[second]) | (sharp & (facing[first] | facing[second]))
    return np.asarray(edges[:-1][shared][shown])


def _pixel(point: Array) -> tuple[int, int]:
    x, y = np.rint(np.clip(point, -1e5, 1e5)).astype(int).tolist()
    return x, y
