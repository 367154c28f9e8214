"""The maps of the floor that is swept today, by broom and person, as the day goes on."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from datetime import date
from functools import reduce

import numpy as np
from inhand_schemas.messages import CameraInfo
from numpy.typing import NDArray

from inhand_outcomes.arrays import Array
from inhand_outcomes.floor_map import (
    FloorMap,
    cells_to_keep,
    empty_map,
    map_of_cells,
    with_depth,
    with_furniture,
    with_sweeping,
)
from inhand_outcomes.gathering import Holding
from inhand_outcomes.measures.footprint import CELL_M
from inhand_outcomes.room import Room
from inhand_outcomes.store.floor_maps import FloorMapHeader, KeptFloorMap
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track


class SweptFloors:
    """What was swept today of the floor, and what stands on it."""

    def __init__(self) -> None:
        self._day: date | None = None
        self._seen = empty_map()
        self._swept: dict[Holding, FloorMap] = {}
        self._changed: set[Holding] = set()

    def begin(self, day: date, kept: Iterable[KeptFloorMap] = ()) -> None:
        """Begin a day, with what is kept of it; what stands on the floor stays, at the first with
        what a process before this one saw of it."""
        if day == self._day:
            return
        maps = {
            Holding(one.object, one.person): map_of_cells(
                one.cells, np.array([one.header.x_m, one.header.y_m])
            )
            for one in kept
        }
        if self._day is None:
            self._seen = reduce(with_furniture, maps.values(), self._seen)
        self._day, self._swept = day, maps
        self._changed.clear()

    def forget(self) -> None:
        """Know nothing of what was swept, until a day begins with what is still kept of it."""
        self._day = None
        self._swept.clear()
        self._changed.clear()

    @property
    def day(self) -> date | None:
        """The day under way."""
        return self._day

    def sweep(
        self, holding: Holding, track: Track, thing: Thing, start_s: float, end_s: float
    ) -> None:
        """Take a sweeping of a track, which may be taken again and again."""
        if not track.floor:
            return
        before = self._swept.get(holding, empty_map())
        after = with_sweeping(before, track, thing, start_s, end_s)
        if not np.array_equal(after.swept, before.swept):
            self._swept[holding] = after
            self._changed.add(holding)

    def see(
        self, depth: NDArray[np.uint16], info: CameraInfo, room: Room, people: Sequence[Array]
    ) -> None:
        """Take what a depth image shows of floor and furniture; the room's floor is known."""
        self._seen = with_depth(self._seen, depth, info, room, people)
        self._changed.update(self._swept)

    def maps(self) -> list[FloorMap]:
        """Return the maps of today."""
        return [replace(self._seen, swept=one.swept) for one in self._swept.values()]

    def to_keep(self) -> Iterator[KeptFloorMap]:
        """Return the maps that have changed since the last time."""
        changed, self._changed = self._changed, set()
        for holding in changed:
            if self._day is None:
                return
            whole = replace(self._seen, swept=self._swept[holding].swept)
            cells = cells_to_keep(whole)
            x, y = whole.corner.tolist()
            header = FloorMapHeader(CELL_M, x, y, *cells.shape)
            yield KeptFloorMap(self._day, holding.object, holding.person, header, cells)
