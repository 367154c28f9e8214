"""What is forgotten is gone from tables, totals and files, and does not come back."""

from datetime import date
from pathlib import Path

import numpy as np
import pytest
from inhand_outcomes.rules import Goal, PersonsGoal, Rules
from inhand_outcomes.store.database import open_database
from inhand_outcomes.store.floor_maps import (
    FloorMapHeader,
    KeptFloorMap,
    floor_maps,
    keep_floor_map,
)
from inhand_outcomes.store.forgetting import Forget, Removed, forget
from inhand_outcomes.store.goal_marks import events_to_publish, judge_goals
from inhand_outcomes.store.queries import last_places, latest
from inhand_outcomes.store.saving import Saver, read_journal
from kept_outcomes import ZURICH, S, all_totals, at, new_saver, sip

NOON = at("2026-05-05 12:00")
NEXT_DAY = at("2026-05-06 12:00")


def home(folder: Path) -> Saver:
    """Two people over two days, with maps, goals and a journal."""
    saver = new_saver(folder)
    outcomes = [sip(time, person=person) for time in (NOON, NEXT_DAY) for person in (0, 1)]
    last = sip(NEXT_DAY + 60 * S, person=1, kind="secret_kind", object="glasses")
    saver.save([*outcomes, last], {"state": b"secret state"})
    header = FloorMapHeader(0.05, 0.0, 0.0, 2, 3)
    for person in (0, 1):
        cells = np.ones((2, 3), np.uint8)
        keep_floor_map(
            saver.database, KeptFloorMap(date(2026, 5, 5), "broom", person, header, cells)
        )
    goals = [
        PersonsGoal(Goal(name=name, kind="sip", at_least=1), person)
        for name, person in (("own", 0), ("others", 1), ("all", None))
    ]
    judge_goals(saver.database, Rules(goals, ZURICH), NOON)
    return saver


def test_a_person_is_forgotten_and_others_are_not(tmp_path: Path) -> None:
    saver = home(tmp_path)
    removed = forget(saver.database, Forget(person=1), NEXT_DAY + 90 * S)
    assert removed == Removed(outcomes=3, totals=3, places=2, floor_maps=1, goals=4)
    assert {one.outcome.person for one in latest(saver.database, 99)} == {0}
    assert [(one.person, one.times) for one in all_totals(saver.database)] == [(0, 1), (0, 1)]
    # The mug is where somebody else had it last; nobody else ever had the glasses.
    assert [(one.object, one.person) for one in last_places(saver.database)] == [("mug", 0)]
    assert [one.person for one in floor_maps(saver.database, date(2026, 5, 5))] == [0]
    assert [event.description for event in events_to_publish(saver.database)] == ["own"]
    assert read_journal(saver.database) == {}


def test_a_day_is_forgotten_and_other_days_are_not(tmp_path: Path) -> None:
    saver = home(tmp_path)
    removed = forget(saver.database, Forget(day=date(2026, 5, 5)), NEXT_DAY + 90 * S)
    assert removed == Removed(outcomes=2, totals=2, places=0, floor_maps=2, goals=6)
    assert {one.day for one in latest(saver.database, 99)} == {date(2026, 5, 6)}
    assert {one.day for one in all_totals(saver.database)} == {date(2026, 5, 6)}
    assert events_to_publish(saver.database) == []


def test_nothing_of_what_is_forgotten_stands_in_the_files(tmp_path: Path) -> None:
    saver = home(tmp_path)
    other = open_database(tmp_path / "outcomes.db")
    assert _somewhere(tmp_path, b"secret_kind")
    forget(other, Forget(everything=True), NEXT_DAY)
    assert not any(_somewhere(tmp_path, text) for text in (b"secret", b"glasses", b"mouth_m"))
    assert all_totals(saver.database) == []
    assert last_places(saver.database) == []


def _somewhere(folder: Path, text: bytes) -> bool:
    return any(text in file.read_bytes() for file in folder.iterdir())


def test_a_daemon_that_runs_does_not_bring_back_what_was_forgotten(tmp_path: Path) -> None:
    saver = home(tmp_path)
    forget(open_database(tmp_path / "outcomes.db"), Forget(person=1), NEXT_DAY + 90 * S)
    late, other = sip(NEXT_DAY + 80 * S, person=1), sip(NEXT_DAY + 80 * S)
    new = sip(NEXT_DAY + 99 * S, person=1)
    saved = saver.save([late, other, new], {"state": b"of person 1"})
    assert saved.forget
    assert (list(saved.forgotten), list(saved.added)) == ([late], [other, new])
    assert read_journal(saver.database) == {}
    saved = saver.save([], {"state": b"begun anew"})
    assert not saved.forget
    assert read_journal(saver.database) == {"state": b"begun anew"}


def test_what_is_played_again_later_is_kept_again(tmp_path: Path) -> None:
    saver = home(tmp_path)
    forget(saver.database, Forget(everything=True), NEXT_DAY + 90 * S)
    saver.save([])
    assert len(saver.save([sip(NOON)]).added) == 1


def test_one_thing_is_forgotten_at_a_time() -> None:
    with pytest.raises(ValueError, match="one of"):
        Forget()
    with pytest.raises(ValueError, match="one of"):
        Forget(person=1, everything=True)
