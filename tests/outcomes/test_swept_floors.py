"""Today's maps of what was swept, as they are kept and gone on with."""

from dataclasses import replace
from datetime import date

from inhand_outcomes.gathering import Holding
from inhand_outcomes.swept_floors import SweptFloors
from seen_table import INFO, ROOM, table_depth
from swept_by_hand import BROOM, broom

TODAY, TOMORROW = date(2026, 11, 30), date(2026, 12, 1)
ANNA = Holding("broom", 1)


def swept_today() -> SweptFloors:
    """What was swept by somebody in one go."""
    floors = SweptFloors()
    floors.begin(TODAY)
    floors.sweep(ANNA, broom(), BROOM, 0.0, 20.0)
    return floors


def test_a_sweeping_is_kept_once_however_often_it_is_seen() -> None:
    floors = swept_today()
    (kept,) = floors.to_keep()
    assert (kept.day, kept.object, kept.person) == (TODAY, "broom", 1)
    assert (kept.cells & 31 > 15).sum() > 20
    floors.sweep(ANNA, broom(), BROOM, 0.0, 20.0)
    assert list(floors.to_keep()) == []


def test_another_process_goes_on_with_what_is_kept() -> None:
    (kept,) = swept_today().to_keep()
    again = SweptFloors()
    again.begin(TODAY, [kept])
    again.sweep(ANNA, broom(turn=1.0), BROOM, 0.0, 20.0)
    (both,) = again.to_keep()
    assert ((both.cells & 31) >= (kept.cells & 31)).all()
    assert (both.cells & 31 > 15).sum() > 1.3 * (kept.cells & 31 > 15).sum()


def test_furniture_that_was_seen_before_a_restart_is_known_after_it() -> None:
    floors = SweptFloors()
    floors.begin(TODAY)
    for _ in range(2):
        floors.see(table_depth(), INFO, ROOM, ())
    floors.sweep(ANNA, broom(), BROOM, 0.0, 20.0)
    (kept,) = floors.to_keep()
    assert (kept.cells >> 5 == 2).sum() > 200  # a table of 1 m2
    again = SweptFloors()
    again.begin(TODAY, [kept])
    again.sweep(ANNA, broom(turn=1.0), BROOM, 0.0, 20.0)
    (both,) = again.to_keep()
    assert (both.cells >> 5 == kept.cells >> 5).all()


def test_a_new_day_begins_with_nothing_swept() -> None:
    floors = swept_today()
    floors.begin(TOMORROW)
    assert floors.maps() == []
    assert list(floors.to_keep()) == []


def test_nothing_is_mapped_where_the_floor_is_not_known() -> None:
    floors = SweptFloors()
    floors.begin(TODAY)
    floors.sweep(ANNA, replace(broom(), floor=False), BROOM, 0.0, 20.0)
    assert floors.maps() == []


def test_what_was_forgotten_is_not_kept_again() -> None:
    floors = swept_today()
    (ours,) = floors.to_keep()
    floors.begin(TOMORROW)
    floors.begin(TODAY, [ours, replace(ours, person=2)])
    floors.forget()
    assert (floors.maps(), floors.day) == ([], None)
    floors.begin(TODAY, [replace(ours, person=2)])
    floors.sweep(ANNA, broom(turn=1.0), BROOM, 0.0, 20.0)
    (again,) = floors.to_keep()
    assert again.person == ANNA.person
    assert len(floors.maps()) == 2
