"""The picture of what was swept of the floor on a day, from the maps that are kept."""

from collections.abc import Sequence
from functools import reduce

import numpy as np

from inhand_outcomes.floor_map import map_of_cells
from inhand_outcomes.store.floor_maps import Cells, KeptFloorMap

SWEPT_BITS, KIND_BITS = 0x1F, 0xE0
"""The bits of a cell that say how surely it was swept, and what it is (``cells_to_keep``)."""

UNSWEPT, UNSWEPT_SIZE = "Nothing was swept yet", (180, 360)
"""What is written where there is no map, and the size of that picture, rows and columns."""


def kept_floor_png(maps: Sequence[KeptFloorMap]) -> bytes:
    """Draw the maps of a day, one at least, as one (PNG), whoever swept; raises ValueError where
    they do not lie on each other."""
    from inhand_outcomes.floor_picture import floor_png

    header = maps[0].header
    if any(one.header != header for one in maps):
        raise ValueError(f"the maps of {maps[0].day} do not lie on each other: forget that day")
    cells = reduce(_together, (one.cells for one in maps))
    return floor_png(map_of_cells(cells, np.array([header.x_m, header.y_m])))


def unswept_png() -> bytes:
    """Draw that nothing was swept (PNG)."""
    import cv2

    picture = np.full((*UNSWEPT_SIZE, 3), 255, np.uint8)
    place = (UNSWEPT_SIZE[1] // 12, UNSWEPT_SIZE[0] // 2)
    cv2.putText(
        picture, UNSWEPT, place, cv2.FONT_HERSHEY_SIMPLEX, 0.8, (60, 60, 60), 1, cv2.LINE_AA
    )
    _, data = cv2.imencode(".png", picture)
    return data.tobytes()


def _together(first: Cells, second: Cells) -> Cells:
    """Cells as the two together show them: what either swept, and the larger kind of the two."""
    swept = np.maximum(first & SWEPT_BITS, second & SWEPT_BITS)
    return np.asarray(swept | np.maximum(first & KIND_BITS, second & KIND_BITS), np.uint8)
