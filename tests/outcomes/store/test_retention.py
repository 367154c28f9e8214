"""Old details go, and the totals of their days stay."""

from datetime import date, timedelta
from pathlib import Path

import pytest
from inhand_outcomes.store.queries import days_kept, last_places, latest
from inhand_outcomes.store.retention import Retention, remove_old
from kept_outcomes import S, all_totals, at, new_saver, sip

TODAY = date(2026, 5, 30)
DAY_NS = 86_400 * S


@pytest.mark.parametrize(
    ("retention", "details", "totals"),
    [
        (Retention(), 30, 30),
        (Retention(days=7), 7, 30),
        (Retention(days=1, totals_days=20), 1, 20),
        (Retention(days=10**9, totals_days=10**9), 30, 30),
    ],
)
def test_details_and_totals_are_kept_for_the_days_of_the_settings(
    tmp_path: Path, retention: Retention, details: int, totals: int
) -> None:
    saver = new_saver(tmp_path)
    saver.save([sip(at("2026-05-01 12:00") + day * DAY_NS) for day in range(30)])
    before = all_totals(saver.database)
    assert remove_old(saver.database, retention, TODAY) == 30 - details
    assert len(latest(saver.database, 99)) == details
    assert all_totals(saver.database) == before[30 - totals :]
    assert days_kept(saver.database) == (TODAY - timedelta(days=totals - 1), TODAY)
    assert [place.day for place in last_places(saver.database)] == [TODAY]


def test_what_is_older_than_the_totals_has_no_place_left(tmp_path: Path) -> None:
    saver = new_saver(tmp_path)
    saver.save([sip(at("2026-05-01 12:00"))])
    remove_old(saver.database, Retention(1, 2), TODAY)
    assert last_places(saver.database) == []
    assert all_totals(saver.database) == []
