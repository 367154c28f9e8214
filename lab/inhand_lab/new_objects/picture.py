"""A picture of an object at true scale beside a hand, with its axes and its marks."""

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import trimesh
from inhand_runtime.errors import InhandError, SettingsError
from inhand_tracker.geometry.arrays import Array, Bytes
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.shape.shape import ObjectShape

from inhand_lab.geometry.canvas import Canvas, draw_triangles
from inhand_lab.geometry.surfaces import Surface, surface_of_mesh
from inhand_lab.geometry.transforms import Transform, normalised
from inhand_lab.new_objects.drawn_hand import HAND_BREADTH, HAND_LENGTH, open_hand

WIDTH, HEIGHT = 560, 520
"""Size in pixels of one of the two views."""
FINER = 2
"""Factor by which it is drawn larger, and then made smaller, for smooth edges."""
DISTANCE = 12.0
"""Distance of the viewer in sizes of what is shown: nearly as from far away."""
SHARE_SHOWN = 0.78
"""Share of a view that what is shown fills."""
GAP, AXIS_BEYOND = 0.03, 0.025
"""Distance between hand and object, and how far the axes stand out of it, metres."""
CLAY, PAPER, INK = (120, 150, 196), (255, 255, 255), (40, 40, 40)
AXIS_COLOURS = {"x": (205, 50, 40), "y": (40, 140, 60), "z": (40, 70, 205)}
MARK_COLOUR = (240, 170, 0)
VIEWPOINTS = {"from ahead and above": (0.75, 1.0, 0.55), "from the side (+x)": (1.0, 0.0, 0.0)}
"""Directions, in the object's frame, from which it is seen, by what is written below."""
SUFFIXES = (".png", ".jpg", ".jpeg")
SCALE_BARS_CM = (1, 2, 5, 10, 20, 50, 100)


@dataclass(frozen=True)
class _View:
    """A viewer of an object: the rows of ``axes`` (3, 3) are right, down and forwards."""

    intrinsics: Intrinsics
    camera_from_object: Transform

    def pixels(self, points: Array) -> Array:
        """Pixels (N, 2) of points (N, 3) in the object's frame."""
        return self.intrinsics.project(self.camera_from_object.apply(points))


def draw_object(shape: ObjectShape) -> Bytes:
    """Draw an object from two sides beside a hand of the same scale, (H, W, 3) RGB."""
    views = [_draw_view(shape, np.array(direction), text) for text, direction in VIEWPOINTS.items()]
    picture = np.concatenate(views, axis=1)
    sides = " x ".join(f"{100.0 * side:.1f}" for side in np.ptp(shape.vertices, axis=0))
    _write(picture, f"{shape.name}: {sides} cm along x, y, z", (14, 26))
    return picture


def require_picture(path: Path) -> None:
    """Raise SettingsError for a name that is no picture's."""
    if path.suffix.lower() not in SUFFIXES:
        raise SettingsError(f"{path} is no picture's name: let it end in {' or '.join(SUFFIXES)}")


def write_picture(picture: Bytes, path: Path) -> None:
    """Write a picture (H, W, 3) RGB to a file; raises InhandError."""
    require_picture(path)
    _, data = cv2.imencode(path.suffix.lower(), cv2.cvtColor(picture, cv2.COLOR_RGB2BGR))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data.tobytes())
    except OSError as error:
        raise InhandError(f"cannot write {path}: {error.strerror}; choose another file") from None


def _draw_view(shape: ObjectShape, direction: Array, text: str) -> Bytes:
    axes = _viewer_axes(direction)
    low, high = shape.vertices.min(axis=0), shape.vertices.max(axis=0)
    hand = _hand_beside(shape.vertices, axes)
    shown = np.concatenate([shape.vertices, hand.vertices, _axis_tips(low, high)])
    view = _view_of(shown, axes)
    canvas = Canvas.blank(view.intrinsics)
    canvas.colour[:] = PAPER
    for surface in (_both_sides(shape), hand):
        placed = surface.moved(view.camera_from_object)
        draw_triangles(
            canvas, view.intrinsics, placed.corners, placed.faces, placed.shades, label=1
        )
    small = cv2.resize(canvas.colour, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)
    picture = np.asarray(small, np.uint8)
    _draw_axes(picture, view, _axis_tips(low, high))
    for place in view.pixels(shape.marked_vertices):
        cv2.circle(picture, _pixel(place), 4, MARK_COLOUR, -1, cv2.LINE_AA)
    _draw_scale(picture, view)
    _write(picture, text, (14, HEIGHT - 14))
    return picture


def _viewer_axes(direction: Array) -> Array:
    """Right, down and forwards (3, 3) of a viewer in a direction (3,) from the object, z up."""
    forwards = -normalised(direction)
    right = normalised(np.cross(forwards, [0.0, 0.0, 1.0]))
    return np.array([right, np.cross(forwards, right), forwards])


def _hand_beside(vertices: Array, axes: Array) -> Surface:
    """The hand to the left of an object as it is seen, at the height of its lower end."""
    right = axes[0]
    left_end = float((vertices @ right).min())
    middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2.0
    aside = left_end - GAP - HAND_BREADTH / 2.0 - float(middle @ right)
    place = middle + aside * right
    place[2] = vertices[:, 2].min()
    upright = np.column_stack([right, np.cross([0.0, 0.0, 1.0], right), [0.0, 0.0, 1.0]])
    return open_hand().moved(Transform(place, upright))


def _view_of(points: Array, axes: Array) -> _View:
    """A view in which all points (N, 3) are seen."""
    seen = points @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    size = max(float((high - low).max()), HAND_LENGTH)
    scale = SHARE_SHOWN * min(WIDTH / (high - low)[0], HEIGHT / (high - low)[1])
    middle = (low + high) / 2.0
    place = np.array([-middle[0], -middle[1], DISTANCE * size - middle[2]])
    focal = FINER * scale * DISTANCE * size
    width, height = FINER * WIDTH, FINER * HEIGHT
    camera = Intrinsics(focal, focal, (width - 1) / 2.0, (height - 1) / 2.0, width, height)
    return _View(camera, Transform(place, axes))


def _both_sides(shape: ObjectShape) -> Surface:
    """The object's surface, whichever way its triangles are turned."""
    faces = np.concatenate([shape.faces, shape.faces[:, ::-1]])
    return surface_of_mesh(trimesh.Trimesh(shape.vertices, faces, process=False), CLAY)


def _axis_tips(low: Array, high: Array) -> Array:
    """Where the arrows (3, 3) of x, y and z end, beyond the box around the object."""
    return np.diag(np.maximum(high, 0.0) + AXIS_BEYOND)


def _draw_axes(picture: Bytes, view: _View, tips: Array) -> None:
    start, *ends = view.pixels(np.concatenate([np.zeros((1, 3)), tips]))
    for (name, colour), end in zip(AXIS_COLOURS.items(), ends, strict=True):
        if np.linalg.norm(end - start) < 8.0 * FINER:
            continue  # it points at the viewer
        cv2.arrowedLine(picture, _pixel(start), _pixel(end), colour, 2, cv2.LINE_AA, tipLength=0.06)
        _write(picture, name, _pixel(end + FINER * np.array([6.0, 4.0])), colour)


def _draw_scale(picture: Bytes, view: _View) -> None:
    """A bar of a round length at the lower right."""
    distance = view.camera_from_object.translation[2]
    per_cm = 0.01 * view.intrinsics.fx / distance / FINER
    length = max((cm for cm in SCALE_BARS_CM if cm * per_cm < 0.3 * WIDTH), default=1)
    right, y = WIDTH - 20, HEIGHT - 24
    cv2.line(picture, (right - round(length * per_cm), y), (right, y), INK, 3)
    _write(picture, f"{length} cm", (right - 52, y - 8))


def _write(
    picture: Bytes, text: str, place: tuple[int, int], colour: tuple[int, int, int] = INK
) -> None:
    cv2.putText(picture, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.55, colour, 1, cv2.LINE_AA)


def _pixel(place: Array) -> tuple[int, int]:
    x, y = np.rint(place / FINER).astype(int).tolist()
    return x, y
