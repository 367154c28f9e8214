"""Placing the visible points of an object for many poses at once."""

import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.kernels.nearest_view import nearest_views
from inhand_tracker.shape.view_grid import view_grid


class VisiblePoints:
    """The points of an object that are seen from the camera, whichever its pose.

    ``directions`` (V, 3) are those of ``Viewpoints``, ``points`` (V, B, 3) one of its arrays.
    """

    def __init__(self, directions: Array, points: Array) -> None:
        self._points = points
        self._directions = np.ascontiguousarray(directions)
        self._grid = view_grid(directions)

    def place(self, translations: Array, orientations: Array) -> Array:
        """Place the visible points (P, B, 3) of poses (P, 3) and (P, 4) in the camera frame."""
        towards_viewer = rotations.rotate(rotations.conjugate(orientations), -translations)
        views = nearest_views(self._grid, self._directions, towards_viewer)
        turns = np.swapaxes(rotations.to_matrix(orientations), -1, -2)
        return self._points[views] @ turns + translations[:, None, :]
