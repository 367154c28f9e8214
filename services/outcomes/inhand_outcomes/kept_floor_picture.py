"""The picture of what was swept of the floor on a day, from the maps that are kept."""

from collections.abc import Iterable, Sequence

import numpy as np

from inhand_outcomes.regions import Region, polygons, whole_floor
from inhand_outcomes.store.floor_maps import KeptFloorMap

UNSWEPT, UNSWEPT_SIZE = "Nothing was swept yet", (180, 360)
"""What is written where there is no map, and the size of that picture, rows and columns."""


def kept_floor_png(maps: Sequence[KeptFloorMap], regions: Iterable[Region] = ()) -> bytes:
    """Draw the maps of a day, one at least, as one (PNG) with its regions, whoever swept; raises
    ValueError where they do not lie on each other."""
    from inhand_outcomes.floor_picture import floor_png

    return floor_png(whole_floor(maps), polygons(regions))


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
