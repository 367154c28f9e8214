"""The point cloud of a camera's depth, while somebody wants it."""

import viser
from inhand_schemas.messages import CameraInfo
from inhand_tracker.geometry.camera import intrinsics_of

from inhand_studio.live_page.parameters import LiveParameters
from inhand_studio.picture import Picture
from inhand_studio.scene_parts import add_points, points_of


class LivePoints:
    """Draws the points of some pictures into a tab's scene."""

    def __init__(self, scene: viser.SceneApi, parameters: LiveParameters) -> None:
        self._scene, self._parameters = scene, parameters
        self._handle: viser.PointCloudHandle | None = None
        self._drawn_at = float("-inf")

    def show(self, picture: Picture | None, info: CameraInfo, now: float) -> None:
        """Draw the points of a picture if it is time, or none; raises MessageError."""
        if picture is None:
            if self._handle is not None:
                self._handle.remove()
                self._handle = None
            return
        if now - self._drawn_at < self._parameters.points_period_s:
            return
        self._drawn_at = now
        depth = picture.depth(info)
        if depth is None:
            return
        points, colours = points_of(
            depth, picture.colour(info), intrinsics_of(info), self._parameters.points_step
        )
        self._handle = add_points(self._scene, "/points", points, colours)
