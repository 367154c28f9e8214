"""The maps of what was swept of the floor, one a day, object and person.

Cells are unsigned bytes, compressed; what each value means is of whoever makes the map.
"""

import zlib
from dataclasses import dataclass
from datetime import date

import msgspec
import numpy as np
from numpy.typing import NDArray
from sqlalchemy import select

from inhand_outcomes.store.database import Database
from inhand_outcomes.store.models import FloorMapRow
from inhand_outcomes.store.saving import number_of, person_of

Cells = NDArray[np.uint8]


class FloorMapHeader(msgspec.Struct, frozen=True):
    """Where the cells (rows, columns) lie: the first cell's corner is at ``x_m``, ``y_m`` of the
    room; rows go along y, columns along x, and each is ``cell_m`` wide."""

    cell_m: float
    x_m: float
    y_m: float
    rows: int
    columns: int


@dataclass(frozen=True)
class KeptFloorMap:
    """The map of a day, an object and a person, None for nobody."""

    day: date
    object: str
    person: int | None
    header: FloorMapHeader
    cells: Cells


def keep_floor_map(database: Database, kept: KeptFloorMap) -> None:
    """Keep a map in place of the one before of the same day, object and person; raises StoreError,
    and ValueError where cells and header disagree."""
    if kept.cells.shape != (kept.header.rows, kept.header.columns):
        raise ValueError(f"cells are {kept.cells.shape}, not as the header says: {kept.header}")
    row = FloorMapRow(
        day=kept.day,
        object=kept.object,
        person=number_of(kept.person),
        header=msgspec.to_builtins(kept.header),
        cells=zlib.compress(np.ascontiguousarray(kept.cells).tobytes()),
    )
    with database.writing() as session:
        session.merge(row)


def floor_maps(database: Database, day: date) -> list[KeptFloorMap]:
    """Return the maps of a day, by object and person; raises StoreError."""
    question = (
        select(FloorMapRow)
        .where(FloorMapRow.day == day)
        .order_by(FloorMapRow.object, FloorMapRow.person)
    )
    with database.reading() as session:
        return [_kept(row) for row in session.scalars(question)]


def _kept(row: FloorMapRow) -> KeptFloorMap:
    header = msgspec.convert(row.header, FloorMapHeader)
    flat = np.frombuffer(zlib.decompress(row.cells), np.uint8)
    cells = flat.reshape(header.rows, header.columns)
    return KeptFloorMap(row.day, row.object, person_of(row.person), header, cells)
