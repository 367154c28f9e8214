"""A floor map as a picture, seen from above, the rig at the bottom."""

from collections.abc import Mapping

import cv2
import numpy as np
from numpy.typing import NDArray

from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.floor_map import DEFAULT_MAP, FloorMap, MapParameters
from inhand_outcomes.measures.footprint import CELL_M

PIXELS = 8
"""Of a cell's side."""
MARGIN = 6
"""Cells beside what is known."""
LEGEND_HEIGHT = 120
UNKNOWN, FLOOR, UNDER, SOLID = (60, 60, 60), (225, 225, 225), (150, 190, 235), (110, 110, 110)
SWEPT, SWEPT_UNDER, REGION, INK = (110, 185, 90), (70, 140, 50), (40, 40, 220), (30, 30, 30)
"""Colours, BGR."""


def floor_png(
    floor_map: FloorMap,
    regions: Mapping[str, Array] | None = None,
    parameters: MapParameters = DEFAULT_MAP,
) -> bytes:
    """Draw a map with its regions, polygons (N, 2) of the room by name, as PNG.

    Green was swept, light is floor and orange floor under furniture that were not. Whole metres
    are marked at the edges.
    """
    swept, under = floor_map.is_swept(parameters), floor_map.is_under(parameters)
    floor = floor_map.is_floor(parameters)
    solid = floor_map.is_solid(parameters)
    image = np.empty((*floor_map.size, 3), np.uint8)
    image[:] = UNKNOWN
    for where, colour in (
        (solid, SOLID),
        (floor, FLOOR),
        (under, UNDER),
        (swept, SWEPT),
        (swept & under, SWEPT_UNDER),
    ):
        image[where] = colour
    low, high = _bounds(swept | floor | under | solid)
    part = image[low[0] : high[0], low[1] : high[1]]
    # Rows of the picture go down, the room's y goes ahead of the rig.
    picture = np.ascontiguousarray(
        np.repeat(np.repeat(part.transpose(1, 0, 2)[::-1], PIXELS, axis=0), PIXELS, axis=1)
    )
    _draw_metres(picture, floor_map.corner + low * CELL_M)
    for name, polygon in (regions or {}).items():
        cells = (polygon - floor_map.corner) / CELL_M - low
        corners = np.stack([cells[:, 0], (high - low)[1] - cells[:, 1]], axis=1) * PIXELS
        outline = np.rint(corners).astype(np.int32)
        cv2.polylines(picture, [outline], isClosed=True, color=REGION, thickness=2)
        _write(picture, name, tuple(outline.min(axis=0) + np.array([4, 16])), REGION)
    whole = np.concatenate([picture, _legend(picture.shape[1], floor_map, parameters)])
    _, data = cv2.imencode(".png", whole)
    return data.tobytes()


def _draw_metres(picture: NDArray[np.uint8], corner: Array) -> None:
    """Write where x and y are whole metres, at the lower and the left edge."""
    height, width = picture.shape[:2]
    for x in range(int(np.ceil(corner[0])), int(corner[0] + width * CELL_M / PIXELS) + 1):
        column = round((x - corner[0]) / CELL_M * PIXELS)
        cv2.line(picture, (column, height - 6), (column, height), REGION, 2)
        _write(picture, f"x {x}", (column + 3, height - 3), REGION)
    for y in range(int(np.ceil(corner[1])), int(corner[1] + height * CELL_M / PIXELS) + 1):
        row = height - round((y - corner[1]) / CELL_M * PIXELS)
        cv2.line(picture, (0, row), (6, row), REGION, 2)
        _write(picture, f"y {y}", (8, row + 5), REGION)


def _bounds(known: Flags) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First and last cell of what is known, with a margin."""
    cells = np.argwhere(known)
    if len(cells) == 0:
        return np.array([0, 0]), np.array(known.shape)
    low = np.maximum(cells.min(axis=0) - MARGIN, 0)
    high = np.minimum(cells.max(axis=0) + MARGIN + 1, known.shape)
    # Wide enough for the legend's words.
    return low, np.maximum(high, np.minimum(low + 36, known.shape))


def _legend(width: int, floor_map: FloorMap, parameters: MapParameters) -> NDArray[np.uint8]:
    """What the colours mean, with areas, and how long a metre is."""
    legend = np.full((LEGEND_HEIGHT, width, 3), 255, np.uint8)
    swept, missed = floor_map.is_swept(parameters), floor_map.is_missed(parameters)
    under = floor_map.is_under(parameters)
    rows = (
        (SWEPT, f"swept {swept.sum() * CELL_M**2:.1f} m2"),
        (FLOOR, f"floor, missed {(missed & ~under).sum() * CELL_M**2:.1f} m2"),
        (UNDER, f"under furniture, missed {(missed & under).sum() * CELL_M**2:.1f} m2"),
    )
    for number, (colour, text) in enumerate(rows):
        top = 10 + 26 * number
        cv2.rectangle(legend, (8, top), (26, top + 16), colour, -1)
        cv2.rectangle(legend, (8, top), (26, top + 16), INK, 1)
        _write(legend, text, (34, top + 13), INK)
    metre = round(PIXELS / CELL_M)
    cv2.line(legend, (8, 104), (8 + metre, 104), INK, 2)
    _write(legend, "1 m", (16 + metre, 109), INK)
    return legend


def _write(
    picture: NDArray[np.uint8], text: str, place: tuple[int, ...], colour: tuple[int, int, int]
) -> None:
    corner = (int(place[0]), int(place[1]))
    cv2.putText(picture, text, corner, cv2.FONT_HERSHEY_SIMPLEX, 0.45, colour, 1, cv2.LINE_AA)
