"""What the end of a thing covers of a plane as it is moved over it: cells with probabilities."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import erf

import numpy as np

from inhand_outcomes.arrays import Array
from inhand_outcomes.normal import normal_share
from inhand_outcomes.thing import Thing

CELL_M = 0.05
"""Side of a cell."""


@dataclass(frozen=True)
class Footprint:
    """The working end of a broom or brush in its own frame: its middle (3,), the direction (3,) in
    which it is wide, its width and depth, metres."""

    middle: Array
    across: Array
    width_m: float
    depth_m: float


@dataclass(frozen=True)
class Cells:
    """Probabilities (X, Y) of square cells to be covered; the first's corner is ``corner`` (2,)."""

    corner: Array
    chances: Array
    cell_m: float = CELL_M


def footprint_of(thing: Thing) -> Footprint:
    """Return the footprint of a thing's end: its part ``head``, or what is lowest of it."""
    middle = thing.part("head", "-z")
    low = thing.vertices[:, 2]
    end = thing.vertices[low <= low.min() + 0.05 * np.ptp(low)]
    sides = np.ptp(end, axis=0)
    across = np.array([1.0, 0.0, 0.0]) if sides[0] >= sides[1] else np.array([0.0, 1.0, 0.0])
    return Footprint(middle, across, float(sides[:2].max()), float(sides[:2].min()))


def swept_cells(
    strokes: Sequence[tuple[Array, Array, Array, float]],
    footprint: Footprint,
    cell_m: float = CELL_M,
    corner: Array | None = None,
    size: tuple[int, int] | None = None,
) -> Cells:
    """Return what strokes cover of a plane.

    A stroke is places (N, 2) of the end's middle, directions (N, 2) of its width, deviations (N,)
    of the places, metres, and the probability of the stroke. Within a stroke errors are alike, so
    a cell's chance is the best of any moment; strokes err apart. ``corner`` and ``size`` are of the
    cells; by default they hold all strokes.
    """
    places = np.concatenate([stroke[0] for stroke in strokes]) if strokes else np.zeros((0, 2))
    reach = 0.5 * np.hypot(footprint.width_m, footprint.depth_m) + 2.0 * cell_m
    if corner is None or size is None:
        low = places.min(axis=0) - reach if len(places) else np.zeros(2)
        high = places.max(axis=0) + reach if len(places) else np.zeros(2)
        corner = np.floor(low / cell_m) * cell_m
        shape = np.ceil((high - corner) / cell_m).astype(int)
        size = (int(shape[0]), int(shape[1]))
    chances = np.zeros(size)
    for where, widths, deviations, chance in strokes:
        covered = np.zeros(size)
        for place, width, deviation in _moments(where, widths, deviations, cell_m):
            _cover(covered, place - corner, width, deviation, footprint, cell_m)
        np.maximum(chances, chance * covered, out=chances)
    return Cells(corner, chances, cell_m)


def _moments(
    places: Array, widths: Array, deviations: Array, cell_m: float
) -> Sequence[tuple[Array, Array, float]]:
    """The moments of a stroke at most half a cell from each other."""
    if len(places) == 0:
        return []
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
    at = np.linspace(0.0, way[-1], int(np.ceil(2.0 * way[-1] / cell_m)) + 1)
    rows = np.clip(np.searchsorted(way, at), 0, len(way) - 1)
    along = np.column_stack([np.interp(at, way, places[:, axis]) for axis in range(2)])
    lengths = np.maximum(np.linalg.norm(widths, axis=1, keepdims=True), 1e-9)
    return list(zip(along, (widths / lengths)[rows], deviations[rows].tolist(), strict=True))


def _cover(
    covered: Array,
    place: Array,
    width: Array,
    deviation: float,
    footprint: Footprint,
    cell_m: float,
) -> None:
    """Raise the chances of cells (X, Y) near a place (2,), counted from their corner, in place."""
    reach = 0.5 * float(np.hypot(footprint.width_m, footprint.depth_m)) + 2.0 * deviation
    first = np.maximum(np.floor((place - reach) / cell_m).astype(int), 0)
    last = np.minimum(np.ceil((place + reach) / cell_m).astype(int), covered.shape)
    if (last <= first).any():
        return
    x = (np.arange(first[0], last[0]) + 0.5) * cell_m - place[0]
    y = (np.arange(first[1], last[1]) + 0.5) * cell_m - place[1]
    along = x[:, None] * width[0] + y[None, :] * width[1]
    square = -x[:, None] * width[1] + y[None, :] * width[0]
    error = max(deviation, 0.2 * cell_m)
    halves = (0.5 * footprint.width_m, 0.5 * footprint.depth_m)
    bounds = [
        sign * half - offset
        for offset, half in zip((along, square), halves, strict=True)
        for sign in (1, -1)
    ]
    shares = normal_share(np.stack(bounds) / error)
    chance = (shares[0] - shares[1]) * (shares[2] - shares[3])
    # A narrow end is never surely over one cell: what counts is whether it passes over it, which
    # the moments before and after say; so along its way the best of them is set to one.
    chance /= max(erf(halves[1] / error / np.sqrt(2.0)), 1e-3)
    part = covered[first[0] : last[0], first[1] : last[1]]
    np.maximum(part, np.minimum(chance, 1.0), out=part)
