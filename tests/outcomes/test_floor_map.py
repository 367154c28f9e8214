"""Maps of a floor: areas by formula, regions, furniture, the picture."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from inhand_outcomes.floor_map import (
    cells_to_keep,
    empty_map,
    map_of_cells,
    region_shares,
    with_depth,
)
from inhand_outcomes.floor_picture import floor_png
from inhand_outcomes.measures.footprint import Footprint, swept_cells
from inhand_outcomes.room import Room
from seen_table import INFO, ROOM, table_depth

HEAD = Footprint(np.zeros(3), np.array([0.0, 1.0, 0.0]), 0.30, 0.06)


def stroke(x_from, x_to, y, error=0.01, chance=1.0):
    places = np.column_stack([np.linspace(x_from, x_to, 20), np.full(20, y)])
    return places, np.tile([0.0, 1.0], (20, 1)), np.full(20, error), chance


def test_a_stroke_covers_its_length_times_the_width_of_the_head():
    cells = swept_cells([stroke(0.0, 0.8, 2.0)], HEAD)
    assert np.sum(cells.chances > 0.5) * 0.05**2 == pytest.approx(0.30 * 0.86, rel=0.08)


def test_the_same_stroke_again_changes_nothing_and_doubt_lowers_every_chance():
    once = swept_cells([stroke(0.0, 0.8, 2.0)], HEAD)
    twice = swept_cells([stroke(0.0, 0.8, 2.0)] * 2, HEAD)
    doubted = swept_cells([stroke(0.0, 0.8, 2.0, chance=0.4)], HEAD)
    assert np.array_equal(once.chances, twice.chances)
    assert doubted.chances.max() == pytest.approx(0.4, abs=0.01)


def test_tells_floor_from_what_is_beneath_a_table_and_what_was_missed_in_a_region():
    floor_map = empty_map()
    for _ in range(2):
        floor_map = with_depth(floor_map, table_depth(), INFO, ROOM)
    centres = floor_map.centres()
    # The floor beneath the table is seen past its edge, the table's top above it.
    on_table = (np.abs(centres[..., 0]) < 0.45) & (np.abs(centres[..., 1] - 2.5) < 0.4)
    beside = (np.abs(centres[..., 0] - 1.0) < 0.2) & (np.abs(centres[..., 1] - 3.0) < 0.2)
    assert floor_map.is_under()[on_table].mean() > 0.9
    assert floor_map.is_floor()[on_table].mean() < 0.1
    assert floor_map.is_floor()[beside].mean() > 0.6
    under = {"under the table": np.array([[-0.5, 2.0], [0.5, 2.0], [0.5, 3.0], [-0.5, 3.0]])}
    share = region_shares(floor_map, under)["under the table"]
    assert share.swept_m2 == 0.0
    assert share.missed_m2 == pytest.approx(1.0, rel=0.05)


def test_what_cannot_be_swept_is_not_missed():
    floor_map = empty_map()
    wall = np.abs(floor_map.centres()[..., 0]) < 0.25
    floor_map = replace(
        floor_map,
        things=np.where(wall, 2, 0).astype(np.int32),
        lowest=np.where(wall, 0.0, np.inf),
        highest=np.where(wall, 2.4, -np.inf),
        swept=np.where(floor_map.centres()[..., 0] > 0.5, 1.0, 0.0),
    )
    square = {"square": np.array([[-1.0, 2.0], [1.0, 2.0], [1.0, 4.0], [-1.0, 4.0]])}
    share = region_shares(floor_map, square)["square"]
    assert share.swept_m2 == pytest.approx(1.0)
    assert share.missed_m2 == pytest.approx(2.0)
    assert share.share == pytest.approx(1 / 3)


def test_a_map_that_was_kept_goes_on_as_it_was():
    floor_map = empty_map()
    for _ in range(2):
        floor_map = with_depth(floor_map, table_depth(), INFO, ROOM)
    cells = swept_cells([stroke(-0.4, 0.4, 1.8)], HEAD, 0.05, floor_map.corner, floor_map.size)
    np.maximum(floor_map.swept, cells.chances, out=floor_map.swept)
    again = map_of_cells(cells_to_keep(floor_map), floor_map.corner)
    assert np.array_equal(again.is_floor(), floor_map.is_floor())
    assert np.array_equal(again.is_under(), floor_map.is_under())
    assert np.array_equal(again.is_swept(), floor_map.is_swept())


def test_people_are_no_furniture():
    joints = np.full((20, 3), np.nan)
    joints[0] = [0.0, -0.2, 2.5]
    joints[3] = [0.0, -0.6, 2.5]
    floor_map = with_depth(empty_map(), table_depth(), INFO, ROOM, [joints])
    middle = np.linalg.norm(floor_map.centres() - [0.0, 2.5], axis=-1) < 0.3
    assert not floor_map.things[middle].any()


def test_a_map_without_a_floor_is_refused():
    with pytest.raises(ValueError, match="floor"):
        with_depth(empty_map(), table_depth(), INFO, Room(ROOM.up))


def test_the_picture_shows_green_where_it_was_swept():
    floor_map = empty_map()
    cells = swept_cells([stroke(-0.4, 0.4, 2.0)], HEAD, 0.05, floor_map.corner, floor_map.size)
    np.maximum(floor_map.swept, cells.chances, out=floor_map.swept)
    png = floor_png(floor_map, {"hall": np.array([[-1, 1.5], [1, 1.5], [1, 2.5], [-1, 2.5]])})
    picture = cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR)
    green = (picture[:-120] == (110, 185, 90)).all(axis=-1)
    assert green.sum() / 64.0 * 0.05**2 == pytest.approx(0.30 * 0.86, rel=0.1)
