"""How much a vessel can hold, upright and tilted, from its mesh.

The mesh is put into cubes. What liquid cannot leave when the vessel stands is its inside; tilted,
it holds what lies below the lowest way out. That is worked out once for each thing.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from inhand_outcomes.arrays import Array, Flags, Indices
from inhand_outcomes.thing import Thing

ML_PER_M3 = 1e6
Labels = NDArray[np.integer[Any]]
LIP = 0.9
"""Cubes, along each axis, by which the way out leads above the lip: one, but for the width of the
last step of the search for it."""


@dataclass(frozen=True)
class VesselParameters:
    """How finely vessels are looked at, and what is assumed of those without an inside."""

    cubes: int = 40
    """Number of cubes along the longest side of the mesh: 2 to 3 mm for a mug, which gives a
    cylinder's volume within 2 %."""
    step_deg: float = 7.5
    """Tilts at which it is worked out; in between it goes straight."""
    deepest_deg: float = 105.0
    """Largest tilt at which it is worked out: nobody drinks beyond."""
    directions: int = 8
    """Number of directions in which a vessel that is not round is tilted."""
    roundness: float = 0.06
    """Share by which what is held at 45 degrees may differ between directions in a round vessel."""
    least_share: float = 0.08
    """Share of the box around the mesh that an inside has at least; a foot's hollow has less."""
    least_depth_m: float = 0.015
    """Least depth of an inside: what is flatter is a plate."""
    wall_m: float = 0.004
    """Wall of a vessel that was taught as a solid: stoneware and glass have 3 to 5 mm."""
    thinnest_m: float = 0.010
    """Half of the thickness below which a part of a solid is no vessel but a handle."""
    deviation: float = 0.04
    """Standard deviation of a volume of an inside as a share of it: taught meshes are within 1 mm
    of 40 mm."""
    solid_deviation: float = 0.15
    """The same of a solid, whose wall and bottom are not known."""


DEFAULT_VESSEL = VesselParameters()


@dataclass(frozen=True)
class Inside:
    """What a vessel can hold.

    ``held_ml`` (A, K) is by direction of the tilt, A of them evenly round from the object's x to
    its y axis, and by ``tilts`` (K,), radians. ``rim`` (3,) is the middle of its opening and
    ``radius`` the opening's, metres, in the object's frame. ``deviation`` is that of a volume as a
    share of it. ``solid`` says that the mesh has no inside, and a wall was assumed.
    """

    tilts: Array
    held_ml: Array
    rim: Array
    radius: float
    deviation: float
    solid: bool

    @property
    def full_ml(self) -> float:
        """What it holds upright."""
        return float(self.held_ml[:, 0].mean())

    def holds(self, tilt: float, towards: float = 0.0) -> float:
        """Millilitres that it holds at a tilt in a direction, radians."""
        around = len(self.held_ml)
        place = (towards / (2.0 * np.pi) * around) % around
        lower = int(place) % around
        share = place - int(place)
        pair = self.held_ml[[lower, (lower + 1) % around]]
        first, second = (float(np.interp(tilt, self.tilts, row)) for row in pair)
        return (1.0 - share) * first + share * second

    def ml_per_radian(self, tilt: float, towards: float = 0.0) -> float:
        """How fast it empties about a tilt, millilitres per radian."""
        step = float(self.tilts[1])
        lower, upper = max(tilt - step, 0.0), tilt + step
        return (self.holds(lower, towards) - self.holds(upper, towards)) / (upper - lower)


@lru_cache(maxsize=64)
def inside_of(thing: Thing) -> Inside | None:
    """What a thing can hold, worked out once; None if it is nothing that holds liquid."""
    return measure_inside(thing.vertices, thing.faces)


def measure_inside(
    vertices: Array, faces: Indices, parameters: VesselParameters = DEFAULT_VESSEL
) -> Inside | None:
    """What a mesh of vertices (V, 3) and faces (F, 3), standing along z, can hold."""
    extents = np.ptp(vertices, axis=0)
    pitch = float(extents.max()) / parameters.cubes
    if not pitch > 0.0:
        return None
    cubes = _Cubes.of(vertices, faces, pitch)
    inside, walls = _pool(cubes)
    least = parameters.least_share * float(np.prod(extents)) / pitch**3
    solid = bool(inside.sum() < least)
    if solid:
        walls, inside = _hollowed(cubes, parameters)
        if inside.sum() < least:
            return None
    depth = np.ptp(np.flatnonzero(inside.any(axis=(0, 1)))) * pitch
    if depth < parameters.least_depth_m:
        return None
    cubes, inside, walls = _cropped(cubes, inside, walls)
    tilts = np.radians(np.arange(0.0, parameters.deepest_deg + 1e-6, parameters.step_deg))

    def held(directions: int, some: Array) -> Array:
        around = np.arange(directions) * 2.0 * np.pi / directions
        return np.array([[_held(cubes, inside, walls, t, a) for t in some] for a in around])

    half = held(4, np.array([np.pi / 4.0]))
    if np.ptp(half) <= parameters.roundness * half.mean():
        table = held(2, tilts).mean(axis=0, keepdims=True)
    else:
        table = held(parameters.directions, tilts)
    table = np.minimum.accumulate(table, axis=1) * ML_PER_M3
    top = np.argwhere(inside)
    places = cubes.places(top[top[:, 2] == top[:, 2].max()])
    rim = np.append(0.5 * (places[:, :2].min(axis=0) + places[:, :2].max(axis=0)), places[0, 2])
    radius = float(np.sqrt(len(places) * pitch**2 / np.pi)) + 0.5 * pitch
    share = parameters.solid_deviation if solid else parameters.deviation
    return Inside(tilts, table, rim, radius, share, solid)


@dataclass(frozen=True)
class _Cubes:
    """Space about a mesh as cubes of ``pitch`` metres; ``surface`` (X, Y, Z) are those it meets."""

    surface: Flags
    origin: Array
    """The middle (3,) of the first cube."""
    pitch: float

    @staticmethod
    def of(vertices: Array, faces: Indices, pitch: float) -> "_Cubes":
        """The cubes that a mesh meets, with two empty ones around."""
        origin = vertices.min(axis=0) - 2.0 * pitch
        shape = np.ceil(np.ptp(vertices, axis=0) / pitch).astype(int) + 5
        surface = np.zeros(shape, bool)
        corners = vertices[faces]
        edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
        pieces = np.ceil(edges / (0.5 * pitch)).astype(int).clip(1)
        for count in np.unique(pieces):
            i, j = (part.ravel() for part in np.meshgrid(*[np.arange(count + 1)] * 2))
            kept = i + j <= count
            shares = np.stack([i, j, count - i - j], axis=1)[kept] / count
            for some in np.array_split(corners[pieces == count], 1 + len(shares) // 2000):
                points = np.einsum("sk,fkx->fsx", shares, some).reshape(-1, 3)
                surface[tuple(np.rint((points - origin) / pitch).astype(int).T)] = True
        return _Cubes(surface, origin, pitch)

    def places(self, indices: Indices) -> Array:
        """The middles (N, 3) of cubes, metres."""
        return np.asarray(self.origin + self.pitch * indices)

    def heights(self, up: Array) -> Array:
        """Height (X, Y, Z) of all cubes along a direction (3,), metres."""
        along = [
            up[axis] * (self.origin[axis] + self.pitch * np.arange(self.surface.shape[axis]))
            for axis in range(3)
        ]
        return np.asarray(along[0][:, None, None] + along[1][:, None] + along[2])


def _outside(labels: Labels) -> Labels:
    """The labels that reach the border of the space."""
    borders = [labels.take(end, axis=axis).ravel() for axis in range(3) for end in (0, -1)]
    return np.unique(np.concatenate(borders))


def _leaves(part: Flags) -> bool:
    """Whether a part reaches the border of the space."""
    return any(bool(part.take(end, axis=axis).any()) for axis in range(3) for end in (0, -1))


def _solid(surface: Flags) -> Flags:
    """A surface with all that it closes in: what is between two sides of a wall."""
    labels, _ = ndimage.label(~surface)
    return ~np.isin(labels, _outside(labels)) | surface


def _pool(cubes: _Cubes) -> tuple[Flags, Flags]:
    """The largest pool that the standing vessel holds, and its walls (X, Y, Z)."""
    walls = _solid(cubes.surface)
    largest = np.zeros_like(walls)
    for level in range(2, walls.shape[2]):
        below = ~walls
        below[:, :, level:] = False
        labels, _ = ndimage.label(below)
        counts = np.bincount(labels.ravel())
        counts[0] = 0
        counts[_outside(labels)] = 0
        if counts.max(initial=0) > largest.sum():
            largest = labels == counts.argmax()
    return largest, walls


def _hollowed(cubes: _Cubes, parameters: VesselParameters) -> tuple[Flags, Flags]:
    """The walls and the inside of a solid whose wall is assumed, open at its top, no handle."""
    solid = _solid(cubes.surface)
    body = _depth(solid, cubes.pitch) > parameters.thinnest_m
    body = solid & (_depth(~body, cubes.pitch) <= parameters.thinnest_m)
    inside = _depth(body, cubes.pitch) > parameters.wall_m + 1.5 * cubes.pitch
    floor = int(np.ceil(parameters.wall_m / cubes.pitch + 0.5))
    inside[:, :, floor:] &= body[:, :, :-floor]
    inside[:, :, :floor] = False
    return body & ~inside, inside


def _depth(part: Flags, pitch: float) -> Array:
    """Distance (X, Y, Z) to what is no part within the same level, metres."""
    across = ndimage.distance_transform_edt(part, sampling=(pitch, pitch, 1e3))
    return np.asarray(across)


def _cropped(cubes: _Cubes, inside: Flags, walls: Flags) -> tuple[_Cubes, Flags, Flags]:
    """The space about an inside with its walls and what stands out of its rim, without a handle."""
    where = np.argwhere(inside)
    reach = int(np.ceil(0.2 * np.ptp(where, axis=0).max())) + 3
    low = np.maximum(where.min(axis=0) - reach, 0)
    high = np.minimum(where.max(axis=0) + reach + 1, inside.shape)
    box = tuple(slice(first, last) for first, last in zip(low, high, strict=True))
    part = _Cubes(cubes.surface[box], cubes.origin + cubes.pitch * low, cubes.pitch)
    return part, inside[box], walls[box]


def _held(cubes: _Cubes, inside: Flags, walls: Flags, tilt: float, towards: float) -> float:
    """Cubic metres that are held at a tilt, radians.

    The level at which what is in the lowest place runs out is found by halving. The way out leads
    over the cubes of the lip, from side to side, and half of the cubes of the wall is inside.
    """
    up = np.array([-np.sin(tilt) * np.cos(towards), -np.sin(tilt) * np.sin(towards), np.cos(tilt)])
    heights = cubes.heights(up)
    lowest = np.unravel_index(np.where(inside, heights, np.inf).argmin(), inside.shape)
    low, high = float(heights[lowest]), float(heights.max())
    pool = np.zeros_like(inside)
    while high - low > 0.2 * cubes.pitch:
        level = 0.5 * (low + high)
        labels, _ = ndimage.label(~walls & (heights <= level))
        label = labels[lowest]
        if label == 0 or not _leaves(labels == label):
            low = level
            pool = labels == label if label else pool
        else:
            high = level
    level = low - LIP * cubes.pitch * float(np.abs(up).sum())
    near = ndimage.binary_dilation(pool, np.ones((3, 3, 3), bool)) & walls
    wet = np.clip((level - heights) / cubes.pitch + 0.5, 0.0, 1.0)
    return float(np.sum(wet * (pool + 0.5 * near))) * cubes.pitch**3
