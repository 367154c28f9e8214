"""Named parts of the floor: how much of each was swept on a day, and how much was missed."""

from collections.abc import Iterable, Mapping, Sequence
from functools import reduce
from typing import Annotated, Self

import numpy as np
from inhand_runtime.settings import Section
from pydantic import Field, model_validator

from inhand_outcomes.arrays import Array
from inhand_outcomes.floor_map import (
    FloorMap,
    RegionShare,
    empty_map,
    map_of_cells,
    region_shares,
)
from inhand_outcomes.named import named
from inhand_outcomes.store.floor_maps import Cells, KeptFloorMap

SWEPT_BITS, KIND_BITS = 0x1F, 0xE0
"""The bits of a cell that say how surely it was swept, and what it is (``cells_to_keep``)."""

Metres = Annotated[float, Field(ge=-6.0, le=6.0)]
"""Within a floor map, which reaches 6 m from the rig."""


class Region(Section):
    """``[[outcomes.NAME.regions]]``: a rectangle of the floor from one corner to the one across,
    each x to the rig's right and y ahead of it, metres from the floor below the rig."""

    name: Annotated[str, named("region")]
    begin: tuple[Metres, Metres] = Field(alias="from")
    end: tuple[Metres, Metres] = Field(alias="to")

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if any(begin == end for begin, end in zip(self.begin, self.end, strict=True)):
            raise ValueError(f"{self.name} has no area: from and to are corners across")
        return self

    @property
    def polygon(self) -> Array:
        """Its corners (4, 2), metres of the room."""
        (x0, y0), (x1, y1) = self.begin, self.end
        return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])


def polygons(regions: Iterable[Region]) -> Mapping[str, Array]:
    """Return the corners of regions by name."""
    return {one.name: one.polygon for one in regions}


def shares_of(maps: Sequence[KeptFloorMap], regions: Iterable[Region]) -> dict[str, RegionShare]:
    """Return how much of each region was swept by the maps of a day, whoever swept; raises
    ValueError where they do not lie on each other."""
    return region_shares(whole_floor(maps), polygons(regions))


def whole_floor(maps: Sequence[KeptFloorMap]) -> FloorMap:
    """Return the maps of a day as one, whoever swept; raises ValueError where they do not lie on
    each other."""
    if not maps:
        return empty_map()
    header = maps[0].header
    if any(one.header != header for one in maps):
        raise ValueError(f"the maps of {maps[0].day} do not lie on each other: forget that day")
    cells = reduce(_together, (one.cells for one in maps))
    return map_of_cells(cells, np.array([header.x_m, header.y_m]))


def _together(first: Cells, second: Cells) -> Cells:
    """Cells as the two together show them: what either swept, and the larger kind of the two."""
    swept = np.maximum(first & SWEPT_BITS, second & SWEPT_BITS)
    return np.asarray(swept | np.maximum(first & KIND_BITS, second & KIND_BITS), np.uint8)
