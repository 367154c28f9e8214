"""The maps of a day: they go on over a restart, and what was forgotten does not come back."""

from datetime import date

import numpy as np
from inhand_outcomes.floor_map import cells_to_keep, empty_map
from inhand_outcomes.measures.footprint import CELL_M
from inhand_outcomes.room import Room
from inhand_outcomes.store.floor_maps import FloorMapHeader, KeptFloorMap
from inhand_outcomes.swept_floors import SweptFloors
from inhand_schemas.messages import CameraInfo

DAY = date(2026, 5, 5)
INFO = CameraInfo(sequence=0, time_ns=0, width=64, height=48, fx=52.5, fy=52.5, cx=31.5, cy=23.5)
ROOM = Room(np.array([0.0, -1.0, 0.0]), -1.2)
DEPTH = np.full((48, 64), 2000, np.uint16)


def a_map(person: int) -> KeptFloorMap:
    floor = empty_map()
    floor.swept[10:20, 10:20] = 1.0
    cells = cells_to_keep(floor)
    x, y = floor.corner.tolist()
    header = FloorMapHeader(CELL_M, x, y, *cells.shape)
    return KeptFloorMap(DAY, "broom", person, header, cells)


def test_the_maps_of_a_day_go_on_with_what_is_seen() -> None:
    floors = SweptFloors()
    floors.begin(DAY, [a_map(0), a_map(1)])
    floors.see(DEPTH, INFO, ROOM, ())
    assert {one.person for one in floors.to_keep()} == {0, 1}
    assert [np.sum(one.swept > 0.5) for one in floors.maps()] == [100, 100]
    assert list(floors.to_keep()) == []


def test_what_was_forgotten_of_a_floor_is_not_kept_again() -> None:
    floors = SweptFloors()
    floors.begin(DAY, [a_map(0), a_map(1)])
    floors.see(DEPTH, INFO, ROOM, ())
    floors.forget()
    floors.see(DEPTH, INFO, ROOM, ())
    assert list(floors.to_keep()) == []
    assert floors.day is None
    floors.begin(DAY, [a_map(1)])
    floors.see(DEPTH, INFO, ROOM, ())
    assert [one.person for one in floors.to_keep()] == [1]
