"""Each act is kept once, and the totals of days are the sums of what is kept."""

import os
import signal
import subprocess
import sys
from collections import defaultdict
from datetime import date
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from inhand_outcomes.achievement import Amount
from inhand_outcomes.outcome import Outcome
from inhand_outcomes.store.database import Database
from inhand_outcomes.store.forgetting import Forget, forget
from inhand_outcomes.store.queries import last_places, latest, outcomes_to_publish
from inhand_outcomes.store.saving import Keeping, mark_outcomes_published, read_journal
from kept_outcomes import KEEPING, ZURICH, S, all_totals, at, new_saver, sip

NOON = at("2026-05-05 12:00")
KILLED = """
import sys
from pathlib import Path
sys.path[:0] = sys.argv[2:]
from kept_outcomes import S, at, new_saver, sip
saver = new_saver(Path(sys.argv[1]))
for number in range(100_000):
    saver.save([sip(at("2026-05-05 12:00") + number * 10 * S)], {"next": str(number + 1).encode()})
    print(number, flush=True)
"""

acts = st.builds(
    lambda start, lasts, **values: sip((start + lasts) * S, start_ns=start * S, **values),
    start=st.integers(NOON // S - 90_000, NOON // S + 90_000),
    lasts=st.integers(0, 30_000),
    ml=st.floats(0.0, 500.0),
    kind=st.sampled_from(["sip", "refill"]),
    person=st.sampled_from([None, 0, 1]),
    probability=st.floats(0.0, 1.0),
)


@settings(max_examples=25)
@given(st.lists(acts, max_size=12), st.randoms())
def test_whatever_comes_again_changes_nothing_and_totals_are_sums(
    outcomes: list[Outcome], random: Random
) -> None:
    with TemporaryDirectory() as folder:
        saver = new_saver(Path(folder))
        added = [*saver.save(outcomes[:5]).added, *saver.save(outcomes[5:]).added]
        before = all_totals(saver.database)
        again = random.sample(outcomes, len(outcomes))
        saved = saver.save(again)
        assert (saved.added, list(saved.known)) == ([], again)
        assert all_totals(saver.database) == before
        kept = latest(saver.database, 1000)
        assert {one.outcome.id for one in kept} == {one.id for one in added}
        assert not any(_overlap(one, two) for one in added for two in added if one is not two)
        _assert_sums(saver.database)
        saver.database.close()


def _overlap(one: Outcome, two: Outcome) -> bool:
    same = (one.kind, one.person) == (two.kind, two.person)
    return same and one.start_ns < two.end_ns and two.start_ns < one.end_ns


def _assert_sums(database: Database) -> None:
    times: dict[object, int] = defaultdict(int)
    ml: dict[object, float] = defaultdict(float)
    for one in latest(database, 1000):
        outcome = one.outcome
        key = (one.day, outcome.kind, outcome.object, outcome.person, one.counted)
        times[key] += 1
        ml[key] += outcome.amounts["volume_ml"].value
    totals = {
        (one.day, one.kind, one.object, one.person, one.counted): one
        for one in all_totals(database)
    }
    assert {key: total.times for key, total in totals.items()} == times
    for key, total in totals.items():
        assert total.amounts["volume_ml"].sum == pytest.approx(ml[key])


def test_what_was_saved_is_read_as_it_was(tmp_path: Path) -> None:
    saver = new_saver(tmp_path)
    outcome = sip(NOON, evidence={"tilt_deg": 52.25, "lost": float("nan")}, person=None)
    saver.save([outcome], {"state": b"\x00\xff", "old": b"1"})
    saver.save([], {"old": None})
    (kept,) = latest(saver.database, 9)
    assert (kept.day, kept.counted) == (date(2026, 5, 5), True)
    assert kept.outcome == sip(NOON, evidence={"tilt_deg": 52.25}, person=None)
    assert read_journal(saver.database) == {"state": b"\x00\xff"}
    (place,) = last_places(saver.database)
    assert (place.time_ns, place.rig_from_object) == (NOON, outcome.rig_from_object)


def test_acts_that_touch_or_are_of_others_are_acts_of_their_own(tmp_path: Path) -> None:
    saver = new_saver(tmp_path)
    first = sip(NOON)
    others = [
        sip(NOON + 2 * S),
        sip(NOON, person=1),
        sip(NOON, object="cup"),
        sip(NOON, kind="hit"),
    ]
    shifted = sip(NOON + S)
    saved = saver.save([first, *others, shifted])
    assert list(saved.added) == [first, *others]
    assert list(saved.known) == [shifted]


def test_what_is_uncertain_is_kept_but_counted_apart(tmp_path: Path) -> None:
    saver = new_saver(tmp_path, Keeping(ZURICH, sure=0.7))
    saver.save([sip(NOON, probability=0.7), sip(NOON + 9 * S, probability=0.69, object="cup")])
    assert [(one.object, one.counted) for one in all_totals(saver.database)] == [
        ("cup", False),
        ("mug", True),
    ]
    assert [place.object for place in last_places(saver.database)] == ["mug"]


def test_no_evidence_is_kept_that_the_settings_do_not_name(tmp_path: Path) -> None:
    saver = new_saver(tmp_path, Keeping(ZURICH, keep=frozenset()))
    saver.save([sip(NOON)])
    (kept,) = latest(saver.database, 1)
    assert kept.outcome.evidence == {}
    assert kept.outcome.rig_from_object is None
    assert last_places(saver.database) == []


def test_no_total_has_places_or_what_is_no_number(tmp_path: Path) -> None:
    saver = new_saver(tmp_path)
    numbers = {"volume_ml": float("nan"), "angle_deg": 40.0, "place_x_m": 1.5}
    saver.save([sip(NOON, amounts={name: Amount(one, 1.0) for name, one in numbers.items()})])
    (total,) = all_totals(saver.database)
    assert set(total.amounts) == {"angle_deg"}
    (kept,) = latest(saver.database, 9)
    assert set(kept.outcome.amounts) == {"angle_deg", "place_x_m"}


def test_a_day_lasts_until_local_midnight_also_when_clocks_change(tmp_path: Path) -> None:
    saver = new_saver(tmp_path, KEEPING)
    midnights = [at("2026-03-30 00:00"), at("2026-10-26 00:00")]
    assert midnights[0] - at("2026-03-29 00:00") == 23 * 3600 * S
    assert midnights[1] - at("2026-10-25 00:00") == 25 * 3600 * S
    for midnight in midnights:
        saver.save([sip(midnight - S), sip(midnight + 2 * S)])
    assert [(one.day.isoformat(), one.times) for one in all_totals(saver.database)] == [
        ("2026-03-29", 1),
        ("2026-03-30", 1),
        ("2026-10-25", 1),
        ("2026-10-26", 1),
    ]


def test_a_clock_that_was_wrong_for_a_while_hides_no_later_place(tmp_path: Path) -> None:
    saver = new_saver(tmp_path)
    saver.clock = lambda: NOON + S
    for time in (at("2031-01-01 00:00"), NOON, NOON - 9999 * S):
        saver.save([sip(time)])
    (place,) = last_places(saver.database)
    assert place.time_ns == NOON


@pytest.mark.long
def test_a_daemon_that_is_killed_has_kept_what_it_saved_with_its_journal(tmp_path: Path) -> None:
    command = [sys.executable, "-c", KILLED, str(tmp_path), *sys.path]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as daemon:
        assert daemon.stdout is not None
        saved = 0
        while saved < 40:
            saved = int(daemon.stdout.readline())
        os.kill(daemon.pid, signal.SIGKILL)
    saver = new_saver(tmp_path)
    number = int(read_journal(saver.database)["next"])
    assert number > 40
    assert len(latest(saver.database, 1000)) == number
    _assert_sums(saver.database)


def test_what_is_saved_waits_until_it_is_published_also_over_restarts(tmp_path: Path) -> None:
    saver = new_saver(tmp_path)
    saver.save([sip(NOON + 10 * S), sip(NOON)])
    saver.database.close()
    database = new_saver(tmp_path).database
    waiting = outcomes_to_publish(database, 1)
    assert [one.id for one in waiting] == [sip(NOON).id]
    mark_outcomes_published(database, [sip(NOON).id])
    assert [one.id for one in outcomes_to_publish(database, 9)] == [sip(NOON + 10 * S).id]
    forget(database, Forget(person=0), NOON + 3600 * S)
    assert outcomes_to_publish(database, 9) == []
