"""A browser's view through a rig's camera: its image stands behind the scene.

The scene is in the camera frame. As soon as somebody turns the scene, it is seen from elsewhere,
and the image goes; it comes back when the browser looks through the camera again.
"""

import numpy as np
from inhand_schemas.messages import CameraInfo
from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.geometry.camera import Intrinsics, intrinsics_of

from inhand_studio.eye import Eye, eye_towards, whole_eye
from inhand_studio.parameters import DEFAULT_STUDIO, StudioParameters
from inhand_studio.visit import Visit

UNKNOWN_CAMERA = Intrinsics(525.0, 525.0, 319.5, 239.5, 640, 480)
"""A usual camera, through which a recording is looked at that does not describe its own."""


class CameraView:
    """What a tab sees of one camera; made and used with the visit's lock held."""

    def __init__(
        self, visit: Visit, camera: Intrinsics, parameters: StudioParameters = DEFAULT_STUDIO
    ) -> None:
        self.camera = camera
        self._client = visit.client
        self._parameters = parameters
        self._target: tuple[Array, float] | None = None
        self._image: tuple[Bytes, Singles | None] | None = None
        self._eye = self._make_eye()
        self._inside = False
        visit.on_look(lambda _: self._moved())
        self.look_through()

    @property
    def inside(self) -> bool:
        """Whether the browser looks through the camera now."""
        return self._inside

    @property
    def eye(self) -> Eye:
        """How it looks through it, or would."""
        return self._eye

    def look_through(self, target: Array | None = None, reach: float = 1.0) -> None:
        """Look through the camera: at all of its image, or ``reach`` metres around a target (3,)
        in the camera frame."""
        self._target = None if target is None else (target, reach)
        self._eye = self._make_eye()
        distance = self._parameters.pivot_m if target is None else float(np.linalg.norm(target))
        camera = self._client.camera
        with self._client.atomic():
            camera.position = np.zeros(3)
            camera.up_direction = -self._eye.camera_from_eye[:, 1]
            camera.look_at = distance * self._eye.camera_from_eye[:, 2]
            camera.fov = self._eye.vertical_angle
        self._inside = True
        self._draw()

    def show(self, colour: Bytes, depth: Singles | None = None) -> None:
        """Show an image (H, W, 3) RGB; by its depth (H, W) in metres it hides what is behind it."""
        self._image = colour, depth
        if self._inside:
            self._draw()

    def hide(self) -> None:
        """Show no image any longer."""
        self._image = None
        self._draw()

    def _moved(self) -> None:
        """Note from where the browser looks now, and in which form of window."""
        inside = self._looks_through()
        aspect = self._eye.lens.width / self._eye.lens.height
        if inside and abs(self._client.camera.aspect / aspect - 1.0) > self._parameters.same_aspect:
            self.look_through(*(self._target or ()))
        elif inside != self._inside:
            self._inside = inside
            self._draw()

    def _looks_through(self) -> bool:
        camera = self._client.camera
        forward = camera.look_at - camera.position
        along = float(forward @ self._eye.camera_from_eye[:, 2] / np.linalg.norm(forward))
        return bool(
            np.linalg.norm(camera.position) < self._parameters.same_place_m
            and np.arccos(min(along, 1.0)) < self._parameters.same_direction_rad
        )

    def _draw(self) -> None:
        """Put the image behind the scene, or take it away."""
        scene = self._client.scene
        if self._image is None or not self._inside:
            scene.set_background_image(None)
            return
        colour, depth = self._image
        scene.set_background_image(
            self._eye.see(colour, self._lens_of(colour)),
            format="jpeg",
            jpeg_quality=self._parameters.jpeg_quality,
            depth=None if depth is None else self._hiding(depth),
        )

    def _hiding(self, depth: Singles) -> Singles:
        """Return the eye's depth, where nothing was measured that of nothing."""
        seen = self._eye.see_depth(depth, self._lens_of(depth))
        return np.where(seen > 0.0, seen, np.float32(self._parameters.unmeasured_m))

    def _lens_of(self, image: Bytes | Singles) -> Intrinsics:
        return self.camera.scaled_to(image.shape[1], image.shape[0])

    def _make_eye(self) -> Eye:
        aspect, height = self._client.camera.aspect, self._parameters.eye_height
        if self._target is None:  # more rows than the camera has would show no more
            return whole_eye(self.camera, aspect, min(height, self.camera.height))
        return eye_towards(*self._target, aspect, height)


def seen_by(info: CameraInfo | None) -> Intrinsics:
    """Return the camera that a recording describes, or a usual one where it describes none."""
    return UNKNOWN_CAMERA if info is None else intrinsics_of(info)
