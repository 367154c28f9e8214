"""A map of a floor: what a broom's head swept of it, what stands on it, and what was missed.

The map lies in the room's frame. What is swept comes from strokes, each with its probability and
the errors of the broom's place; adding the same stroke twice changes nothing. What is floor, and
what has furniture above it, comes from depth images.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from inhand_schemas.messages import CameraInfo
from numpy.typing import NDArray

from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.measures.footprint import CELL_M, footprint_of, swept_cells
from inhand_outcomes.measures.sweeping import groups_of, strokes
from inhand_outcomes.room import Room
from inhand_outcomes.rotations import matrices
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track


@dataclass(frozen=True)
class MapParameters:
    """What depth images say of a cell."""

    half_side_m: float = 6.0
    """Half of a map's side, about the rig: farther than depth cameras measure."""
    stride: int = 3
    """Every so many pixels of a row and of a column are looked at."""
    furthest_m: float = 4.5
    """Range beyond which depth is too coarse for cells of 5 cm."""
    floor_m: float = 0.04
    """Distance from the plane within which a point is of the floor: 2 cm of plane and tracker,
    twice."""
    person_m: float = 0.45
    """Level distance from a joint within which a point is of the person or what they hold."""
    looks: int = 2
    """Images, at least, in which something must be seen: people pass, furniture stays."""
    beneath_m: float = 0.12
    """Height below which nothing of a piece of furniture is seen that one can sweep beneath."""
    wall_m: float = 1.9
    """Height from which it is a wall or a wardrobe."""
    swept: float = 0.5
    """Probability from which a cell is swept."""


DEFAULT_MAP = MapParameters()


@dataclass(frozen=True)
class FloorMap:
    """Square cells (X, Y) from ``corner`` (2,), metres of the room: ``swept`` is the probability
    that each was swept, ``floor`` and ``things`` in how many images its floor and something above
    it were seen, ``lowest`` and ``highest`` the heights of that, metres."""

    corner: Array
    swept: Array
    floor: NDArray[np.int32]
    things: NDArray[np.int32]
    lowest: Array
    highest: Array

    @property
    def size(self) -> tuple[int, int]:
        """Number of cells along x and y."""
        return self.swept.shape[0], self.swept.shape[1]

    def centres(self) -> Array:
        """The middles (X, Y, 2) of the cells, metres of the room."""
        x, y = (
            corner + CELL_M * (np.arange(n) + 0.5)
            for corner, n in zip(self.corner, self.size, strict=True)
        )
        return np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)

    def is_swept(self, parameters: MapParameters = DEFAULT_MAP) -> Flags:
        """Cells (X, Y) that were swept."""
        return self.swept >= parameters.swept

    def seen_under(self, parameters: MapParameters = DEFAULT_MAP) -> Flags:
        """Cells (X, Y) with furniture above them, as was seen, that one can sweep beneath."""
        above = (self.things >= parameters.looks) & (self.highest < parameters.wall_m)
        return above & ((self.lowest > parameters.beneath_m) | (self.floor >= parameters.looks))

    def seen_floor(self, parameters: MapParameters = DEFAULT_MAP) -> Flags:
        """Cells (X, Y) of open floor, as was seen."""
        return (self.floor >= parameters.looks) & (self.things < parameters.looks)

    def is_under(self, parameters: MapParameters = DEFAULT_MAP) -> Flags:
        """Cells (X, Y) with furniture above them that one can sweep beneath."""
        return self._filled(self.seen_under(parameters), self.things == 0)

    def is_floor(self, parameters: MapParameters = DEFAULT_MAP) -> Flags:
        """Cells (X, Y) of open floor."""
        unknown = (self.floor == 0) & (self.things == 0)
        return self._filled(self.seen_floor(parameters), unknown) & ~self.is_under(parameters)

    def _filled(self, flags: Flags, free: Flags) -> Flags:
        """The flags (X, Y) with ``free`` cells, between the pixels of a slanting view, where three
        neighbours have the flag."""
        padded = np.pad(flags, 1).astype(np.int32)
        rows = padded[:-2] + padded[1:-1] + padded[2:]
        near = rows[:, :-2] + rows[:, 1:-1] + rows[:, 2:]
        return flags | (free & (near >= 3))

    def is_solid(self, parameters: MapParameters = DEFAULT_MAP) -> Flags:
        """Cells (X, Y) with something above them that one cannot sweep beneath."""
        return (self.things >= parameters.looks) & ~self.is_under(parameters)

    def is_missed(self, parameters: MapParameters = DEFAULT_MAP) -> Flags:
        """Cells (X, Y) that can be swept and were not."""
        return (self.is_floor(parameters) | self.is_under(parameters)) & ~self.is_swept(parameters)


@dataclass(frozen=True)
class RegionShare:
    """Of a named region: the area that was swept, with its deviation, and that was missed, square
    metres. What cannot be swept is neither."""

    swept_m2: float
    deviation_m2: float
    missed_m2: float

    @property
    def share(self) -> float:
        """The share that was swept of what can be."""
        return self.swept_m2 / max(self.swept_m2 + self.missed_m2, CELL_M**2)


def empty_map(parameters: MapParameters = DEFAULT_MAP) -> FloorMap:
    """Return a map about the rig of which nothing is known."""
    cells = round(2.0 * parameters.half_side_m / CELL_M)
    nothing = np.zeros((cells, cells))
    counts = np.zeros((cells, cells), np.int32)
    corner = np.full(2, -parameters.half_side_m)
    return FloorMap(corner, nothing, counts, counts, nothing + np.inf, nothing - np.inf)


def with_sweeping(
    floor_map: FloorMap, track: Track, thing: Thing, start_s: float, end_s: float
) -> FloorMap:
    """Return the map with a sweeping of a track from ``start_s`` to ``end_s``."""
    found = [stroke for group in groups_of(strokes(track, thing)) for stroke in group]
    within = [
        (stroke.places, stroke.widths, stroke.deviations, stroke.probability)
        for stroke in found
        if stroke.start_s < end_s and stroke.end_s > start_s
    ]
    cells = swept_cells(within, footprint_of(thing), CELL_M, floor_map.corner, floor_map.size)
    return replace(floor_map, swept=np.maximum(floor_map.swept, cells.chances))


def with_depth(
    floor_map: FloorMap,
    depth: NDArray[np.uint16],
    info: CameraInfo,
    room: Room,
    people: Sequence[Array] = (),
    parameters: MapParameters = DEFAULT_MAP,
) -> FloorMap:
    """Return the map with what a depth image (H, W) shows of floor and furniture.

    ``people`` are joints (20, 3) in the rig's frame; what is near them is passed over. Raises
    ValueError where the room's floor is not known.
    """
    if room.floor_height is None:
        raise ValueError("a map needs the floor")
    points = _in_room(depth, info, room, parameters)
    for joints in people:
        known = joints[np.isfinite(joints).all(axis=1)]
        body = (known @ room.matrix.T + room.translation)[:, :2] if len(known) else known
        for joint in body:
            points = points[np.linalg.norm(points[:, :2] - joint, axis=1) > parameters.person_m]
    cells = np.floor((points[:, :2] - floor_map.corner) / CELL_M).astype(int)
    inside = ((cells >= 0) & (cells < floor_map.size)).all(axis=1)
    cells, heights = cells[inside], points[inside, 2]
    on_floor = np.abs(heights) < parameters.floor_m
    above = heights > 1.5 * parameters.floor_m
    lowest, highest = floor_map.lowest.copy(), floor_map.highest.copy()
    np.minimum.at(lowest, tuple(cells[above].T), heights[above])
    np.maximum.at(highest, tuple(cells[above].T), heights[above])
    return replace(
        floor_map,
        floor=floor_map.floor + _any(cells[on_floor], floor_map.size),
        things=floor_map.things + _any(cells[above], floor_map.size),
        lowest=lowest,
        highest=highest,
    )


def with_furniture(floor_map: FloorMap, other: FloorMap) -> FloorMap:
    """Return the map with what another of the same cells knows of floor and furniture."""
    return replace(
        floor_map,
        floor=floor_map.floor + other.floor,
        things=floor_map.things + other.things,
        lowest=np.minimum(floor_map.lowest, other.lowest),
        highest=np.maximum(floor_map.highest, other.highest),
    )


def region_shares(
    floor_map: FloorMap, regions: Mapping[str, Array], parameters: MapParameters = DEFAULT_MAP
) -> dict[str, RegionShare]:
    """Return how much of each region, a polygon (N, 2) of the room by its name, was swept."""
    centres, cell = floor_map.centres(), CELL_M**2
    swept, solid = floor_map.is_swept(parameters), floor_map.is_solid(parameters)
    shares = {}
    for name, polygon in regions.items():
        inside = _inside(centres, polygon)
        chances = floor_map.swept[inside]
        shares[name] = RegionShare(
            float(np.sum(swept[inside])) * cell,
            float(np.sum(chances * (1.0 - chances))) * cell,
            float(np.sum(inside & ~swept & ~solid)) * cell,
        )
    return shares


def cells_to_keep(
    floor_map: FloorMap, parameters: MapParameters = DEFAULT_MAP
) -> NDArray[np.uint8]:
    """Return the map as bytes (Y, X): rows go along the room's y, columns along x.

    The lower five bits are the probability that the cell was swept, of 31; above them are two bits:
    0 unknown, 1 floor, 2 under furniture, 3 what cannot be swept.
    """
    kinds = np.zeros(floor_map.size, np.uint8)
    kinds[floor_map.things >= parameters.looks] = 3
    kinds[floor_map.seen_under(parameters)] = 2
    kinds[floor_map.seen_floor(parameters)] = 1
    return np.asarray((np.rint(31.0 * floor_map.swept).astype(np.uint8) | kinds << 5).T)


def map_of_cells(
    cells: NDArray[np.uint8], corner: Array, parameters: MapParameters = DEFAULT_MAP
) -> FloorMap:
    """Return the map that was kept as ``cells_to_keep`` says, to be gone on with."""
    kinds, swept = cells.T >> 5, (cells.T & 31) / 31.0
    looks = np.int32(parameters.looks)
    return FloorMap(
        corner,
        swept,
        np.where(kinds == 1, looks, 0).astype(np.int32),
        np.where(kinds >= 2, looks, 0).astype(np.int32),
        np.where(kinds == 2, 2.0 * parameters.beneath_m, np.where(kinds == 3, 0.0, np.inf)),
        np.where(kinds >= 2, 2.0 * parameters.beneath_m, -np.inf),
    )


def _in_room(
    depth: NDArray[np.uint16], info: CameraInfo, room: Room, parameters: MapParameters
) -> Array:
    """Points (N, 3) of the room that a depth image shows."""
    rows, columns = depth.shape
    v, u = np.mgrid[0 : rows : parameters.stride, 0 : columns : parameters.stride]
    z = depth[v, u].ravel() * info.depth_scale
    near = (z > 0.0) & (z < parameters.furthest_m)
    x = (u.ravel()[near] * info.width / columns - info.cx) / info.fx
    y = (v.ravel()[near] * info.height / rows - info.cy) / info.fy
    points = np.stack([x, y, np.ones(len(x))], axis=1) * z[near, None]
    pose = info.rig_from_camera
    in_rig = points @ matrices(pose.rotation).T + np.array(pose.translation)
    return in_rig @ room.matrix.T + room.translation


def _any(cells: NDArray[np.int64], size: tuple[int, int]) -> NDArray[np.int32]:
    """One (X, Y) where there is any of the cells (N, 2)."""
    flags = np.zeros(size, np.int32)
    flags[tuple(cells.T)] = 1
    return flags


def _inside(points: Array, polygon: Array) -> Flags:
    """Where points (..., 2) are inside a polygon (N, 2): a ray from there cuts it oddly often."""
    inside = np.zeros(points.shape[:-1], bool)
    x, y = points[..., 0], points[..., 1]
    for (x0, y0), (x1, y1) in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        if y0 != y1:
            crosses = (y0 > y) != (y1 > y)
            inside ^= crosses & (x < x0 + (y - y0) * (x1 - x0) / (y1 - y0))
    return inside
