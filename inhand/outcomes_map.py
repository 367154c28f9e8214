"""Writes the picture of what was swept of the floor on a day."""

from collections.abc import Sequence
from pathlib import Path

from inhand_outcomes.kept_floor_picture import kept_floor_png
from inhand_outcomes.regions import Region
from inhand_outcomes.store.floor_maps import KeptFloorMap
from inhand_runtime.errors import InhandError


def draw_floor_maps(maps: Sequence[KeptFloorMap], regions: Sequence[Region], path: Path) -> None:
    """Draw the maps of a day as one (PNG) with its regions, whoever swept; raises InhandError."""
    try:
        picture = kept_floor_png(maps, regions)
    except ValueError as error:
        raise InhandError(str(error)) from None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(picture)
    except OSError as error:
        raise InhandError(f"cannot write {path}: {error.strerror}; choose another file") from None
