"""The picture of what was swept of the floor on a day."""

from collections.abc import Sequence
from functools import reduce
from pathlib import Path

import numpy as np
from inhand_outcomes.floor_map import map_of_cells
from inhand_outcomes.floor_picture import floor_png
from inhand_outcomes.store.floor_maps import Cells, KeptFloorMap
from inhand_runtime.errors import InhandError

SWEPT_BITS, KIND_BITS = 0x1F, 0xE0
"""The bits of a cell that say how surely it was swept, and what it is (``cells_to_keep``)."""


def draw_floor_maps(maps: Sequence[KeptFloorMap], path: Path) -> None:
    """Draw the maps of a day as one (PNG), whoever swept; raises InhandError."""
    header = maps[0].header
    if any(one.header != header for one in maps):
        raise InhandError(f"the maps of {maps[0].day} do not lie on each other: forget that day")
    cells = reduce(_together, (one.cells for one in maps))
    picture = floor_png(map_of_cells(cells, np.array([header.x_m, header.y_m])))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(picture)
    except OSError as error:
        raise InhandError(f"cannot write {path}: {error.strerror}; choose another file") from None


def _together(first: Cells, second: Cells) -> Cells:
    """Cells as the two together show them: what either swept, and the larger kind of the two."""
    swept = np.maximum(first & SWEPT_BITS, second & SWEPT_BITS)
    return np.asarray(swept | np.maximum(first & KIND_BITS, second & KIND_BITS), np.uint8)
