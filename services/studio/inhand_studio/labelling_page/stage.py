"""What the labelling page draws: the frame's image or points, the people, the object, its handles.

All is in the camera frame.
"""

from collections.abc import Callable
from typing import Literal

import cv2
import numpy as np
from inhand_lab.labelling.equal_poses import Pose
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.shape.shape import ObjectShape

from inhand_studio.camera_view import CameraView, seen_by
from inhand_studio.drawn_scene import DrawnScene
from inhand_studio.labelling_page.opened import OpenedRecording
from inhand_studio.labelling_page.parameters import DEFAULT_PAGE, LabellingPageParameters
from inhand_studio.labelling_page.placing import SAME_ROTATION
from inhand_studio.labelling_page.shown_pose import Standing
from inhand_studio.scene_parts import (
    TRUE,
    Colour,
    add_object,
    add_points,
    points_of,
)
from inhand_studio.visit import Visit

Look = Literal["colour", "depth", "3-D"]
LOOKS: tuple[Look, ...] = ("colour", "depth", "3-D")

COLOURS: dict[Standing, Colour] = {
    "keyframe": (250, 120, 40),
    "between": (60, 170, 250),
    "refined": (150, 90, 250),
    "guess": (150, 150, 150),
    "absent": (150, 150, 150),
}

WIDE_RAD = 0.9
"""Angle from top to bottom that the 3-D view sees, as a browser's usual one."""


class Stage:
    """What a tab sees of one recording and object; used with the visit's lock held."""

    def __init__(
        self,
        visit: Visit,
        recording: OpenedRecording,
        shape: ObjectShape,
        on_drag: Callable[[Pose, Pose, str], None],
        parameters: LabellingPageParameters = DEFAULT_PAGE,
    ) -> None:
        """Draw nothing yet. ``on_drag`` gets the handles' pose before and now, and the phase:
        "start", "update" or "end"."""
        self._scene = visit.client.scene
        self._client = visit.client
        self._recording = recording
        self._parameters = parameters
        self._middle = 0.5 * (shape.vertices.min(axis=0) + shape.vertices.max(axis=0))
        self.radius = float(np.linalg.norm(shape.vertices - self._middle, axis=1).max())
        self._view = CameraView(visit, seen_by(recording.info))
        self._look: Look = "colour"
        self._zoomed: Array | None = None
        self._object = add_object(self._scene, "/object", shape, COLOURS["guess"], 0.55)
        self._true = add_object(self._scene, "/labelled", shape, TRUE, 0.35)
        self._true.visible = False
        self._drawn = DrawnScene(self._scene)
        self._cloud = add_points(
            self._scene, "/points", np.zeros((1, 3), np.float32), np.zeros((1, 3), np.uint8)
        )
        self._cloud.visible = False
        self._handles = self._scene.add_transform_controls(
            "/handles", self._parameters.handles * self.radius, depth_test=False
        )
        self._handles_pose: Pose = np.zeros(3), SAME_ROTATION
        self._standing: Standing = "guess"
        self._clicking = False

        def moved(event: object) -> None:
            phase = str(getattr(event, "phase", "update"))
            on_drag(self._handles_pose, (self._handles.position, self._handles.wxyz), phase)

        self._handles.on_update(visit.action(moved))

    @property
    def camera(self) -> Intrinsics:
        """The camera that is looked through."""
        return self._view.camera

    @property
    def inside(self) -> bool:
        """Whether the browser looks through the camera, so that clicks are at its pixels."""
        return self._view.inside

    def show_frame(self, frame: int) -> None:
        """Show the image, or the points, and the people of a frame; raises RecordingError."""
        image = self._recording.image(frame)
        people = self._recording.people(frame)
        with self._client.atomic():
            self._drawn.draw_people(people)
            self._cloud.visible = self._look == "3-D" and image is not None
            if self._look == "3-D" and image is not None:
                self._show_points(image)
            self._view.show(*self._picture(image))

    def show_object(self, pose: Pose | None, standing: Standing, axes: Array) -> None:
        """Show the object at a pose, or not at all, and its handles along axes (4,)."""
        self._object.visible = pose is not None
        self._handles.visible = pose is not None and not self._clicking
        if standing != self._standing:
            self._standing, self._object.color = standing, COLOURS[standing]
        if pose is None:
            return
        self.move_object(pose)
        middle = self.middle_of(pose)
        self._handles_pose = middle, axes
        self._handles.position, self._handles.wxyz = middle, axes
        if self._zoomed is not None:
            self._follow(middle)

    def await_clicks(self, clicking: bool) -> None:
        """Take the handles away, which would take clicks on the object, or bring them back."""
        self._clicking = clicking
        self._handles.visible = self._object.visible and not clicking

    def move_object(self, pose: Pose) -> None:
        """Show the object elsewhere while its handles are dragged."""
        self._object.position, self._object.wxyz = pose

    def show_label(self, pose: Pose | None) -> None:
        """Show, in green, where the recording's own label has the object; None for nowhere."""
        self._true.visible = pose is not None
        if pose is not None:
            self._true.position, self._true.wxyz = pose

    def look(self, look: Look, middle: Array) -> None:
        """Look through the camera at colours or depths, or at the scene (about a point) from
        beside it."""
        self._look = look
        if look != "3-D":
            self._look_through()
            return
        beside = rotations.from_vector(np.array([0.0, self._parameters.beside, 0.0]))
        distance = float(np.linalg.norm(middle))
        if self._zoomed is not None:
            distance = self._parameters.zoom_reach * self.radius / np.tan(0.5 * WIDE_RAD)
        camera = self._client.camera
        with self._client.atomic():
            camera.position = middle - distance * rotations.rotate(
                beside, middle / np.linalg.norm(middle)
            )
            camera.up_direction = np.array([0.0, -1.0, 0.0])
            camera.look_at = middle
            camera.fov = WIDE_RAD

    def zoom(self, middle: Array | None) -> None:
        """Look at the object's middle (3,), and follow it; None for all of the picture."""
        self._zoomed = middle
        if self._look != "3-D":
            self._look_through()

    @property
    def zoomed(self) -> bool:
        """Whether it looks at a part of the picture."""
        return self._zoomed is not None

    def middle_of(self, pose: Pose) -> Array:
        """Return where the object's middle (3,) is at a pose."""
        return np.asarray(pose[0] + rotations.rotate(pose[1], self._middle))

    def _follow(self, middle: Array) -> None:
        reach = self._parameters.zoom_reach * self.radius
        if self._zoomed is not None and np.linalg.norm(middle - self._zoomed) > 0.5 * reach:
            self.zoom(middle)

    def _look_through(self) -> None:
        reach = self._parameters.zoom_reach * self.radius
        if self._zoomed is None or self._zoomed[2] <= 0.0:
            self._view.look_through()
        else:
            self._view.look_through(self._zoomed, reach)

    def _picture(self, image: Image | None) -> tuple[Bytes, Singles | None]:
        """Return what is behind the scene, and the depth that hides what is behind that."""
        depth = None if image is None else image.depth
        if self._look == "depth" or image is None or image.colour is None:
            camera = self._view.camera
            colour = (
                np.zeros((camera.height, camera.width, 3), np.uint8)
                if depth is None
                else false_colours(depth, self._parameters.deepest_m)
            )
        else:
            colour = image.colour
        if depth is None:
            return colour, None
        behind = np.where(depth > 0.0, depth + np.float32(self._parameters.surface_m), 0.0)
        return colour, behind.astype(np.float32)

    def _show_points(self, image: Image) -> None:
        if image.depth is None:
            self._cloud.visible = False
            return
        self._cloud.points, self._cloud.colors = points_of(
            image.depth, image.colour, self._view.camera, self._parameters.cloud_step
        )


def false_colours(depth: Singles, deepest_m: float) -> Bytes:
    """Colour depths (H, W) in metres from red, near, to blue; black where none was measured."""
    shares = np.clip(1.0 - depth / deepest_m, 0.0, 1.0)
    colours = cv2.applyColorMap((255.0 * shares).astype(np.uint8), cv2.COLORMAP_TURBO)
    colours[depth <= 0.0] = 0
    return np.ascontiguousarray(colours[..., ::-1], np.uint8)
