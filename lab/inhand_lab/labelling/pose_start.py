"""A first pose of an object in a frame, from what a person clicks on.

Three or more points of the object that are clicked on in the image give all of its pose (Horn
1987). One click alone gives its place: it keeps its rotation.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, permutations, product

import numpy as np
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.image import Image
from inhand_tracker.geometry.kernels.nearest_rotation import nearest_rotation
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.sight.silhouette import silhouette_depths

from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.keyframes import LabellingError
from inhand_lab.labelling.measured_depth import point_at, points_near
from inhand_lab.labelling.parameters import DEFAULT_LABELLING, LabellingParameters

FEWEST = 3
"""Points that fix a pose."""
MOST_TRIED = 6
"""Points of which every order is tried, and every surface around the pixels."""


@dataclass(frozen=True)
class PickedPoint:
    """A ``pixel`` (2,), x and y in the image, at which a point (3,) of the object's surface is
    seen; ``point`` is in metres in the object's frame."""

    pixel: Array
    point: Array


def pose_from_clicks(
    picked: Sequence[PickedPoint],
    image: Image,
    parameters: LabellingParameters = DEFAULT_LABELLING,
) -> Pose:
    """Return the pose camera_from_object that brings points of an object to where they are seen.

    Raises LabellingError for fewer than three points, for points that are in one place or on one
    line, for pixels without depth, and where no pose brings the points there.
    """
    points = np.array([one.point for one in picked], float).reshape(-1, 3)
    _require_spread(points, "the points on the object", parameters)
    seen = _places(points, [points_near(image, one.pixel, parameters) for one in picked])
    pose = pose_from_points(points, seen)
    _require_fit(points, seen, pose, parameters)
    _require_spread(seen, "the places clicked on in the image", parameters)
    return pose


def pose_from_points(points: Array, seen: Array) -> Pose:
    """Return the rigid pose that brings ``points`` (N, 3) nearest to where they are ``seen``
    (N, 3), by least squares; N is 3 or more, not on a line."""
    centre, there = points.mean(axis=0), seen.mean(axis=0)
    matrix = np.empty((3, 3))
    nearest_rotation((seen - there).T @ (points - centre), matrix)
    rotation = rotations.from_matrix(matrix)
    return there - rotations.rotate(rotation, centre), rotation


def pose_at_click(
    shape: ObjectShape,
    rotation: Array,
    image: Image,
    pixel: Array,
    parameters: LabellingParameters = DEFAULT_LABELLING,
) -> Pose:
    """Return the pose with this ``rotation`` (4,) in which the middle of the object is seen at a
    pixel (2,), its surface at the depth that was measured there.

    Where nothing of the object covers its middle, as in a ring, the middle has that depth. Raises
    LabellingError for a pixel outside the image or without depth.
    """
    seen = point_at(image, pixel, parameters)
    middle = 0.5 * (shape.vertices.min(axis=0) + shape.vertices.max(axis=0))
    offset = rotations.rotate(rotation, middle)
    camera, direction = image.camera, seen / seen[2]
    reach = 2.0 * float(np.linalg.norm(shape.vertices - middle, axis=1).max())
    column, row = np.rint(pixel).astype(int)
    place = seen + direction * reach
    for _ in range(parameters.placing_steps):
        surface = silhouette_depths(shape, place - offset, rotation, camera)[row, column]
        if not np.isfinite(surface):
            return seen - offset, rotation
        place = place + direction * (seen[2] - surface)
    return place - offset, rotation


def _require_spread(points: Array, named: str, parameters: LabellingParameters) -> None:
    """Raise LabellingError for points (N, 3) that do not fix a rotation."""
    if len(points) < FEWEST:
        raise LabellingError(
            f"{len(points)} of {FEWEST} points: click on {FEWEST} or more of the object, and on "
            "each where it is seen in the image"
        )
    if not np.isfinite(points).all():
        raise LabellingError(f"{named} hold numbers that are not finite: pick them again")
    for one, other in combinations(range(len(points)), 2):
        if np.linalg.norm(points[one] - points[other]) < parameters.least_apart_m:
            raise LabellingError(
                f"points {one + 1} and {other + 1} of {named} are in the same place: choose "
                "others, as far apart as can be"
            )
    _, spread, _ = np.linalg.svd(points - points.mean(axis=0))
    if spread[1] < parameters.least_aside_share * spread[0]:
        raise LabellingError(
            f"{named} are on one line, about which the object could turn: choose one beside it"
        )


def _places(points: Array, surfaces: Sequence[Array]) -> Array:
    """Return where points (N, 3) are seen (N, 3), of the surfaces (S, 3) around each one's pixel:
    those that are apart from each other as the points are."""
    first = np.array([one[0] for one in surfaces])
    if len(points) > MOST_TRIED:
        return first
    choices = [np.array(one) for one in product(*surfaces)]
    return min(
        choices, key=lambda seen: _distances(points, seen, pose_from_points(points, seen)).max()
    )


def _require_fit(points: Array, seen: Array, pose: Pose, parameters: LabellingParameters) -> None:
    """Raise LabellingError where a pose does not bring points (N, 3) to where they are seen."""
    size = float(np.linalg.norm(points - points.mean(axis=0), axis=1).max())
    allowed = parameters.click_off_m + parameters.click_off_share * size
    off = _distances(points, seen, pose)
    better, least = _best_order(points, seen)
    worst = float(off.max())
    exchanged = worst > parameters.exchanged_m and least < parameters.exchanged_share * worst
    if worst <= allowed and not exchanged:
        return
    told = f"point {1 + int(off.argmax())} is {100 * worst:.1f} cm from where it was clicked on: "
    if exchanged and least <= allowed:
        order = ", ".join(str(1 + one) for one in better)
        raise LabellingError(
            f"{told}the places in the image fit in the order {order}; click on them in that of "
            "the points on the object"
        )
    raise LabellingError(f"{told}pick that pair again, and see that nothing covers it")


def _best_order(points: Array, seen: Array) -> tuple[tuple[int, ...], float]:
    """Return the order of places (N, 3) in which points (N, 3) fit best, and by how many metres the
    worst is off then. Of very many points their own order alone is tried."""
    every = permutations(range(len(points))) if len(points) <= MOST_TRIED else []
    orders = [tuple(range(len(points))), *every]
    worst = [
        float(_distances(points, places, pose_from_points(points, places)).max())
        for places in (seen[list(order)] for order in orders)
    ]
    best = int(np.argmin(worst))
    return orders[best], worst[best]


def _distances(points: Array, seen: Array, pose: Pose) -> Array:
    """Return the metres (N,) from where a pose brings points to where they are seen."""
    placed = rotations.rotate(pose[1], points) + pose[0]
    return np.asarray(np.linalg.norm(placed - seen, axis=1))
