"""Maps of the floor are kept small, the newest of each day."""

from datetime import date
from pathlib import Path

import numpy as np
import pytest
from inhand_outcomes.store.floor_maps import (
    FloorMapHeader,
    KeptFloorMap,
    floor_maps,
    keep_floor_map,
)
from inhand_outcomes.store.models import FloorMapRow
from kept_outcomes import new_saver
from sqlalchemy import select

DAY = date(2026, 5, 5)
HEADER = FloorMapHeader(0.05, -3.0, -1.5, 160, 120)


def test_the_last_map_of_a_day_is_read_as_it_was(tmp_path: Path) -> None:
    database = new_saver(tmp_path).database
    cells = np.zeros((160, 120), np.uint8)
    for row in (50, 60):
        cells[row, 10:100] = 3
        keep_floor_map(database, KeptFloorMap(DAY, "broom", None, HEADER, cells.copy()))
    keep_floor_map(database, KeptFloorMap(date(2026, 5, 6), "broom", None, HEADER, cells))
    (kept,) = floor_maps(database, DAY)
    assert (kept.header, kept.object, kept.person) == (HEADER, "broom", None)
    np.testing.assert_array_equal(kept.cells, cells)
    with database.reading() as session:
        assert max(map(len, session.scalars(select(FloorMapRow.cells)))) < 200


def test_cells_that_are_not_as_the_header_says_are_refused(tmp_path: Path) -> None:
    cells = np.zeros((120, 160), np.uint8)
    with pytest.raises(ValueError, match="header"):
        keep_floor_map(new_saver(tmp_path).database, KeptFloorMap(DAY, "broom", 0, HEADER, cells))
