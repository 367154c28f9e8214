"""Fits things that stand upright on a table: a box, and round things by their outline.

A round thing is a polyline of radii and heights turned about an upright axis: the distance of a
point from its surface is that of its radius and height from the polyline, in the plane.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array
from scipy.optimize import least_squares

from inhand_lab.new_objects.parameters import MeasuringParameters
from inhand_lab.objects.turned_shapes import (
    Outline,
    bottle_outline,
    cup_outline,
    cylinder_outline,
)


@dataclass(frozen=True)
class FittedShape:
    """A shape on a table.

    ``kind`` and ``measures`` (metres) are as ``objects.kinds`` has them, ``centre`` (2,) is where
    its axis meets the table, ``turn`` its turn about z in radians, and ``distances`` (N,) are those
    of the points from its surface, metres.
    """

    kind: str
    measures: Mapping[str, float]
    centre: Array
    turn: float
    distances: Array


def fit_box(points: Array, parameters: MeasuringParameters) -> FittedShape:
    """Fit an upright box to points (N, 3) in the table's frame, from the least by its footprint.

    The points move the sides that they see; one that is not seen stays where the footprint ends.
    """
    angles = 0.5 * np.pi * np.arange(parameters.yaw_steps) / parameters.yaw_steps
    ends = [_extent(points[:, :2] @ _turn(angle), parameters) for angle in angles]
    best = int(np.argmin([float(np.prod(high - low)) for low, high in ends]))
    low, high = ends[best]
    middle = _turn(angles[best]) @ ((low + high) / 2.0)
    start = np.array([*middle, angles[best], *(high - low), _height(points, parameters)])

    def distances(values: Array) -> Array:
        return _box_distances(points, values)

    found = least_squares(distances, start, loss="soft_l1", f_scale=parameters.soft_m)
    x, y, turn, width, depth, height = found.x.tolist()
    measures = {"height": height, "width": abs(width), "depth": abs(depth)}
    return FittedShape("box", measures, np.array([x, y]), turn, distances(found.x))


def _box_distances(points: Array, values: Array) -> Array:
    """Distances (N,) of points (N, 3) from an upright box: its centre, turn and sides, (6,)."""
    local = np.column_stack(
        ((points[:, :2] - values[:2]) @ _turn(values[2]), points[:, 2] - values[5] / 2.0)
    )
    beyond = np.abs(local) - np.abs(values[3:]) / 2.0
    outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
    inside = np.minimum(beyond.max(axis=1), 0.0)
    distances: Array = np.abs(outside + inside)
    return distances


def fit_cylinder(points: Array, parameters: MeasuringParameters) -> FittedShape:
    """Fit an upright cylinder to points (N, 3) in the table's frame."""

    def measures(height: float, values: Array) -> dict[str, float]:
        return {"height": height, "diameter": 2.0 * values[0]}

    return _fit_round("cylinder", cylinder_outline, measures, np.array([1.0]), points, parameters)


def fit_cup(points: Array, parameters: MeasuringParameters) -> FittedShape:
    """Fit a cup without a handle, open above, to points (N, 3) in the table's frame."""

    def measures(height: float, values: Array) -> dict[str, float]:
        return {"height": height, "diameter": 2.0 * values[0], "foot": 2.0 * values[1]}

    return _fit_round("cup", cup_outline, measures, np.array([1.0, 0.9]), points, parameters)


def fit_bottle(points: Array, parameters: MeasuringParameters) -> FittedShape:
    """Fit a bottle with a neck to points (N, 3) in the table's frame."""

    def measures(height: float, values: Array) -> dict[str, float]:
        radius, neck, shoulder = values
        low = min(max(shoulder / radius, 0.1), parameters.highest_shoulder)
        narrow, wide = parameters.neck_shares
        return {
            "height": height,
            "diameter": 2.0 * radius,
            "neck": 2.0 * min(max(neck, narrow * radius), wide * radius),
            "shoulder": low * height,
        }

    start = np.array([1.0, 0.4, 0.6])
    return _fit_round("bottle", bottle_outline, measures, start, points, parameters)


def outline_distances(radii: Array, heights: Array, outline: Outline) -> Array:
    """Distances (N,) in a plane of points of radii and heights (N,) from a polyline."""
    corners = np.array(outline)
    starts, along = corners[:-1], np.diff(corners, axis=0)
    points = np.column_stack((radii, heights))[:, None]
    lengths = np.maximum(np.einsum("si,si->s", along, along), 1e-18)
    shares = np.clip(np.einsum("nsi,si->ns", points - starts, along) / lengths, 0.0, 1.0)
    nearest = starts + shares[..., None] * along
    distances: Array = np.linalg.norm(points - nearest, axis=2).min(axis=1)
    return distances


def _fit_round(
    kind: str,
    outline: Callable[..., Outline],
    measures: Callable[[float, Array], dict[str, float]],
    start: Array,
    points: Array,
    parameters: MeasuringParameters,
) -> FittedShape:
    """Fit centre and measures of a round thing; ``start`` is in radii of its footprint."""
    height = _height(points, parameters)
    low, high = _extent(points[:, :2], parameters)
    radius = float((high - low).max()) / 2.0
    # Only the side that faces the camera, at -y, may be seen.
    middle = np.array([(low[0] + high[0]) / 2.0, low[1] + radius])

    def distances(values: Array) -> Array:
        made = measures(values[2], values[3:])
        radii = np.linalg.norm(points[:, :2] - values[:2], axis=1)
        return outline_distances(radii, points[:, 2], outline(**made))

    # A flat side is a part of a large enough circle, but such a thing would be seen as wide.
    sizes = np.full(len(start), radius)
    lowest, highest = parameters.height_shares
    found = least_squares(
        distances,
        np.concatenate((middle, [height], start * radius)),
        bounds=(
            [*(middle - radius), lowest * height, *(parameters.smallest_radius_share * sizes)],
            [*(middle + radius), highest * height, *(parameters.largest_radius_share * sizes)],
        ),
        loss="soft_l1",
        f_scale=parameters.soft_m,
        x_scale=radius,
    )
    made = {name: float(value) for name, value in measures(found.x[2], found.x[3:]).items()}
    return FittedShape(kind, made, found.x[:2], 0.0, distances(found.x))


def _extent(values: Array, parameters: MeasuringParameters) -> tuple[Array, Array]:
    """Lowest and highest of points (N, 2), without the outermost."""
    share = parameters.outermost
    low, high = np.quantile(values, (share, 1.0 - share), axis=0)
    return low, high


def _height(points: Array, parameters: MeasuringParameters) -> float:
    return float(np.quantile(points[:, 2], 1.0 - parameters.outermost))


def _turn(angle: float) -> Array:
    """The matrix (2, 2) that turns by an angle in radians."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
