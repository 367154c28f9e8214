"""The daemon of outcomes in a rig: what it publishes and keeps, and over which ends."""

import json
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from carried_cup import CUP, START_NS, Carrying, write_model
from inhand_outcomes.memory import Memory
from inhand_outcomes.pausing import Pausing
from inhand_outcomes.rules import Rules
from inhand_outcomes.service import OutcomesLoop
from inhand_outcomes.settings import OutcomesSettings
from inhand_outcomes.store.database import open_database
from inhand_outcomes.store.queries import KeptOutcome, latest
from inhand_outcomes.store.retention import Retention
from inhand_outcomes.store.saving import read_journal
from inhand_outcomes.store.waiting import WaitingOutcomes
from inhand_outcomes.watching import Watcher
from inhand_runtime.daemon import running_daemon
from inhand_runtime.settings import load_settings
from kept_outcomes import ZURICH, S, new_saver, sip
from running_rig import Process, RunningRig, eventually

pytestmark = pytest.mark.long
SCRIPT = Path(__file__).parents[1] / "scenes" / "carrying_publisher.py"


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[RunningRig]:
    rig = RunningRig(tmp_path)
    yield rig
    rig.close()


def start(rig: RunningRig, more: str = "") -> Process:
    """A daemon that measures the cup, and is up."""
    model = write_model(rig.folder / "cup.model")
    rig.configure(f'[outcomes.home]\nmodels = ["{model}"]\ntime_zone = "Europe/Zurich"\n{more}')
    daemon = rig.inhand("outcomes", "--config", rig.config, "--name", "home")
    daemon.said("is up")
    return daemon


def carry(rig: RunningRig, *arguments: str) -> None:
    """Publish somebody who carries the cup, to the end."""
    publisher = rig.python(SCRIPT, "--meeting", rig.meeting, *arguments)
    assert publisher.wait() == 0, publisher.stderr


def kept(rig: RunningRig) -> list[KeptOutcome]:
    """What the database has, the earliest first."""
    database = open_database(rig.folder / "outcomes.db")
    try:
        return sorted(latest(database, 100), key=lambda one: one.outcome.end_ns)
    finally:
        database.close()


def kinds(rig: RunningRig) -> list[str]:
    return [one.outcome.kind for one in kept(rig)]


def test_what_is_achieved_is_published_and_kept(rig: RunningRig) -> None:
    start(rig)
    echo = rig.inhand("echo", "event", "--json", "--count", "2", "--config", rig.config)
    carry(rig)
    assert echo.wait() == 0
    events = [json.loads(line)["message"] for line in echo.stdout.splitlines()]
    assert [event["kind"] for event in events] == ["taken_up", "put_down"]
    assert kinds(rig) == ["taken_up", "put_down"]
    assert [one.outcome.id for one in kept(rig)] == [event["id"] for event in events]
    assert events[1]["amounts"].keys() == {"place_x_m", "place_y_m", "place_z_m"}


def test_what_was_saved_before_a_kill_and_not_published_is_published_once(
    rig: RunningRig,
) -> None:
    saver = new_saver(rig.folder)
    saver.save([sip(START_NS), sip(START_NS + 10 * S)])
    saver.database.close()
    echo = rig.inhand("echo", "event", "--json", "--config", rig.config)
    start(rig)
    ids = [sip(START_NS).id, sip(START_NS + 10 * S).id]

    def said() -> list[str]:
        return [json.loads(line)["message"]["id"] for line in echo.stdout.splitlines()]

    eventually("both", lambda: len(said()) == 2)
    carry(rig, "--start-ns", str(START_NS + 60 * S), "--speed", "9")
    eventually("the next acts", lambda: len(said()) == 4)
    assert said()[:2] == ids


def test_what_a_tracker_takes_as_always_in_use_counts_only_where_settings_say_so(
    rig: RunningRig,
) -> None:
    unsaid = ("--without-recogniser", "--speed", "9")
    goal = '[[outcomes.home.goals]]\nname = "tea"\nkind = "sip"\nobject = "cpu"\nat_least = 1\n'
    daemon = start(rig, goal)
    carry(rig, *unsaid, "--until", "3")
    assert sorted(one.partition(":")[0] for one in rig.health("home")["troubles"]) == [
        "nothing is measured of cup",
        "the goal tea counts 'cpu', which is not measured (did you mean cup?)",
    ]
    daemon.stop()
    start(rig, 'always_in_use = ["cup"]\n')
    carry(rig, *unsaid)
    eventually("both acts", lambda: kinds(rig) == ["taken_up", "put_down"])
    assert rig.health("home")["troubles"] == []


def test_a_killed_daemon_counts_nothing_twice_and_loses_nothing(rig: RunningRig) -> None:
    daemon = start(rig)
    carry(rig, "--until", "4.5")
    eventually("its memory to be written", lambda: journal_until(rig) >= 4.4)
    daemon.stop(signal.SIGKILL)
    start(rig)
    carry(rig, "--from", "3.5", "--times", "1")
    eventually("both acts", lambda: len(kinds(rig)) == 2)
    carry(rig, "--from", "5.0")  # a player that goes back
    carry(rig, "--start-ns", str(START_NS + 60 * 10**9))
    eventually("the next two", lambda: len(kinds(rig)) >= 4)
    assert kinds(rig) == ["taken_up", "put_down"] * 2


def test_what_is_remembered_at_a_start_waits_for_the_next_captures(rig: RunningRig) -> None:
    before, again = (Watcher({"cup": CUP}, "inhand/rig") for _ in range(2))
    for skeletons, pose in Carrying().messages(4.5):  # of another time than the host's
        before.hear_skeletons("front", skeletons)
        before.hear_pose(pose)
    saver = new_saver(rig.folder)
    saver.save([], Memory(before).entries())
    rig.configure("[outcomes.home]")
    settings = load_settings(rig.config, "outcomes", OutcomesSettings)
    with running_daemon("outcomes", settings) as daemon:
        waiting, rules = WaitingOutcomes(lambda: saver), Rules([], ZURICH)
        loop = OutcomesLoop(daemon, again, waiting, rules, Retention(), Pausing())
        loop.recall()
        assert again.end_quiet(loop.pose_clock.now_ns()) == []
        assert len(again.followed) == 1
    saver.database.close()


def test_a_capture_from_years_ahead_makes_nothing_that_is_kept_too_old(rig: RunningRig) -> None:
    saver, now_ns = new_saver(rig.folder), time.time_ns()
    saver.save([sip(now_ns)])
    rig.configure("[outcomes.home]")
    settings = load_settings(rig.config, "outcomes", OutcomesSettings)
    with running_daemon("outcomes", settings) as daemon:
        waiting, watcher = WaitingOutcomes(lambda: saver), Watcher({}, "inhand/rig")
        rules, retention = Rules([], ZURICH), Retention(days=400)
        loop = OutcomesLoop(daemon, watcher, waiting, rules, retention, Pausing())
        loop.clock.hear(now_ns + 500 * 86_400 * S)
        daemon.stop.set()
        loop.run()
    assert [one.outcome.kind for one in kept(rig)] == ["sip"]


def journal_until(rig: RunningRig) -> float:
    """Until which second of the publisher the daemon's memory is written."""
    database = open_database(rig.folder / "outcomes.db")
    try:
        watcher = Watcher({}, "inhand/rig")
        Memory(watcher).recall(read_journal(database))
    finally:
        database.close()
    ends = [one.gathering.last_ns for one in watcher.followed.values()]
    return (max(ends, default=START_NS) - START_NS) * 1e-9


def test_a_goal_that_is_reached_is_said_once(rig: RunningRig) -> None:
    goal = '[[outcomes.home.goals]]\nname = "tidy"\nkind = "put_down"\nat_least = 2\n'
    start(rig, goal)
    echo = rig.inhand("echo", "event", "--json", "--config", rig.config)
    carry(rig, "--times", "3")

    def said() -> list[str]:
        return [json.loads(line)["message"]["kind"] for line in echo.stdout.splitlines()]

    eventually("all six acts", lambda: len([one for one in said() if one != "goal_reached"]) == 6)
    eventually("the goal", lambda: "goal_reached" in said())
    assert said().count("goal_reached") == 1


def test_what_is_kept_can_be_looked_at_and_forgotten_while_the_daemon_runs(rig: RunningRig) -> None:
    start(rig)
    carry(rig)
    eventually("both acts", lambda: len(kinds(rig)) == 2)
    ask = ("--config", rig.config, "--json", rig.folder / "answer.json")
    assert rig.done("outcomes", "where", "cup", *ask).popen.returncode == 0
    assert json.loads((rig.folder / "answer.json").read_text())["kind"] == "put_down"
    assert rig.done("outcomes", "forget", "--all", "--yes", *ask).popen.returncode == 0
    assert json.loads((rig.folder / "answer.json").read_text())["removed"]["outcomes"] == 2
    # What the daemon sees before it hears of it is forgotten as well: the first may be.
    carry(rig, "--start-ns", str(START_NS + 60 * 10**9), "--times", "2")
    eventually("the next acts", lambda: kinds(rig)[-2:] == ["taken_up", "put_down"])


def test_a_second_daemon_of_one_database_is_refused_and_told_by_whom(rig: RunningRig) -> None:
    daemon = start(rig, "[outcomes.shed]\n")
    other = rig.inhand("outcomes", "--config", rig.config, "--name", "shed")
    assert other.wait() == 1
    assert f"another daemon, outcomes home of inhand/rig, process {daemon.pid}" in other.stderr


def test_without_objects_the_daemon_says_so_in_its_health(rig: RunningRig) -> None:
    rig.configure("[outcomes.home]")
    rig.inhand("outcomes", "--config", rig.config).said("is up")
    assert any("no object is measured" in one for one in rig.health("home")["troubles"])
