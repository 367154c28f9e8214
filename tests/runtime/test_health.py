"""What an instance tells about itself."""

import logging
import os
import subprocess
import sys
import time
from pathlib import Path

import msgpack
import pytest
from inhand_runtime.health import (
    LOOP_LATE_S,
    MOST_KEYS,
    MOST_TROUBLES,
    PASSING_LASTS_S,
    WINDOW_S,
    HealthBoard,
)
from inhand_schemas.errors import MessageError
from inhand_schemas.topics import HEALTH
from manager_stand_in import Manager


def test_traffic_is_counted_by_key() -> None:
    board = HealthBoard("tracker", "first")
    for _ in range(3):
        board.published("a")
    board.received("b")
    board.dropped("b")
    report = board.report()
    assert (report.service, report.instance, report.state) == ("tracker", "first", "starting")
    assert report.topics["a"].published == 3
    assert report.topics["a"].rate_hz > 0
    assert (report.topics["b"].received, report.topics["b"].dropped) == (1, 1)


def test_a_rate_is_that_since_the_last_report() -> None:
    board = HealthBoard("tracker", "first")
    board.published("a")
    board.report()
    assert board.report().topics["a"].rate_hz == 0
    assert board.report().sequence == 2


def test_latency_is_from_capture_to_now_and_ignores_foreign_clocks() -> None:
    board = HealthBoard("tracker", "first")
    board.latency(time.time_ns() + 10**9)
    board.latency(1)
    assert board.report().latency_ms is None
    board.latency(time.time_ns() - 20_000_000)
    latency = board.report().latency_ms
    assert latency is not None
    assert 20 <= latency.p50 <= latency.p99 < 60_000


def test_each_kind_of_malformed_message_is_logged_once(caplog: pytest.LogCaptureFixture) -> None:
    board = HealthBoard("tracker", "first")
    with caplog.at_level(logging.WARNING):
        for _ in range(4):
            board.malformed("a", MessageError("no valid Skeletons"))
    assert board.report().topics["a"].malformed == 4
    assert len(caplog.records) == 1


def test_the_last_error_is_told(caplog: pytest.LogCaptureFixture) -> None:
    board = HealthBoard("capture", "front")
    board.error("first")
    board.error("x" * 10_000)
    report = board.report()
    assert report.last_error == "x" * 4096
    assert len(caplog.records) == 2


def test_a_sender_of_ever_new_keys_cannot_make_health_grow_without_bound() -> None:
    board = HealthBoard("tracker", "first")
    for number in range(2 * MOST_KEYS):
        board.received(f"key{number}")
    report = board.report()
    assert len(report.topics) == MOST_KEYS + 1
    assert sum(topic.received for topic in report.topics.values()) == 2 * MOST_KEYS
    assert HEALTH.decode(HEALTH.encode(report)) == report


def test_how_late_a_key_s_messages_arrived_is_the_longest_since_the_last_report() -> None:
    board = HealthBoard("tracker", "first")
    for late_ms in (3.0, 250.0, 20.0):
        board.received("a")
        board.arrived("a", round(late_ms * 1e6))
    assert board.report().topics["a"].late_ms == 250.0
    assert board.report().topics["a"].late_ms is None


@pytest.mark.parametrize("late_ns", [-1_000_000_000, 3_600_000_000_000])
def test_times_of_another_clock_or_a_replay_are_no_lateness(late_ns: int) -> None:
    board = HealthBoard("tracker", "first")
    board.received("a")
    board.arrived("a", late_ns)
    assert board.report().topics["a"].late_ms is None


def test_an_instance_says_its_effort_where_it_has_one() -> None:
    board = HealthBoard("tracker", "first")
    assert board.report().effort is None
    board.effort = 0.25
    assert board.report().effort == 0.25


class Clock:
    """Seconds that pass when a test says so."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def test_a_latency_of_long_ago_is_no_latency_of_now() -> None:
    clock = Clock()
    board = HealthBoard("tracker", "first", clock)
    board.latency(time.time_ns() - 20_000_000)
    assert board.report().latency_ms is not None
    clock.now += WINDOW_S + 1.0
    assert board.report().latency_ms is None


def test_a_running_instance_with_a_trouble_is_degraded_until_it_is_well() -> None:
    board = HealthBoard("capture", "front")
    board.state = "running"
    board.trouble("source", "the camera is away")
    report = board.report()
    assert (report.state, report.troubles) == ("degraded", ("the camera is away",))
    board.well("source")
    report = board.report()
    assert (report.state, report.troubles) == ("running", ())
    assert report.last_error == "the camera is away"


def test_a_trouble_that_lasts_is_logged_once(caplog: pytest.LogCaptureFixture) -> None:
    board = HealthBoard("capture", "front")
    for _ in range(5):
        board.trouble("source", "the camera is away")
    assert len(caplog.records) == 1


def test_a_trouble_whose_numbers_change_is_logged_once_and_told_as_it_is_now(
    caplog: pytest.LogCaptureFixture,
) -> None:
    board = HealthBoard("tracker", "first")
    for count in (12, 13, 9):
        board.trouble("late", f"{count} of 90 frames came late")
    assert len(caplog.records) == 1
    assert board.report().troubles == ("9 of 90 frames came late",)
    board.trouble("late", "no frame comes")
    assert len(caplog.records) == 2


def test_malformed_messages_are_a_trouble_while_they_come(caplog: pytest.LogCaptureFixture) -> None:
    clock = Clock()
    board = HealthBoard("tracker", "first", clock)
    board.state = "running"
    board.malformed("a", MessageError("no valid Skeletons"))
    report = board.report()
    assert report.state == "degraded"
    assert report.last_error == "a: dropped a message: no valid Skeletons"
    clock.now += PASSING_LASTS_S + 1.0
    board.came_round()
    assert board.report().state == "running"


def test_a_main_loop_that_does_not_come_round_is_told() -> None:
    clock = Clock()
    board = HealthBoard("tracker", "first", clock)
    board.state = "running"
    clock.now += LOOP_LATE_S + 1.0
    report = board.report()
    assert report.loop_age_s == LOOP_LATE_S + 1.0
    assert "main loop has not come round" in report.troubles[0]
    board.came_round()
    assert board.report().troubles == ()


@pytest.mark.parametrize(
    ("numbers", "lost"),
    [([3, 4, 5], 0), ([3, 6, 7], 2), ([9, 2, 3], 0), ([1, 1, 2], 0), ([0, 2**62, 2**62 + 2], 1)],
)
def test_what_never_came_is_counted_by_the_numbers(numbers: list[int], lost: int) -> None:
    board = HealthBoard("recorder", "disk")
    for number in numbers:
        board.received("a", number)
    assert board.report().topics["a"].lost == lost


def test_troubles_that_a_sender_invents_are_bounded() -> None:
    board = HealthBoard("tracker", "first")
    for number in range(1000):
        board.trouble(f"name {number}", "x" * 10_000)
    report = board.report()
    assert len(report.troubles) == MOST_TROUBLES
    assert HEALTH.decode(HEALTH.encode(report)) == report


def test_what_the_inbox_had_no_room_for_is_dropped_and_not_lost_as_well() -> None:
    board = HealthBoard("tracker", "mug")
    board.received("a", 1)
    board.overflowed("a")
    board.overflowed("a")
    board.received("a", 6)
    board.received("a", 7)
    topic = board.report().topics["a"]
    assert (topic.dropped, topic.lost) == (2, 2)


def test_what_a_message_holds_does_nothing_to_a_log(caplog: pytest.LogCaptureFixture) -> None:
    board = HealthBoard("tracker", "first")
    said = msgpack.packb({"state": "\n\x1b[2J12:00:00 hub ERROR forged"})
    with pytest.raises(MessageError) as caught:
        HEALTH.decode(said)
    board.malformed("health/front", caught.value)
    board.malformed("health/front", MessageError("\n\x1b[2Jforged"))
    (trouble,) = board.report().troubles
    for text in (trouble, *caplog.messages):
        assert text.isprintable()


WITHOUT_FILES = """
import resource, sys
from inhand_runtime.health import HealthBoard
from inhand_runtime.service_manager import ServiceManager
board, manager = HealthBoard("hub", "hub"), ServiceManager()
before = board.report().resident_bytes
resource.setrlimit(resource.RLIMIT_NOFILE, (0, resource.getrlimit(resource.RLIMIT_NOFILE)[1]))
manager.advanced()
health = board.report()
assert health.resident_bytes == before
print(health.troubles[0])
"""


def test_one_that_can_open_no_more_files_says_so_and_that_it_lives(tmp_path: Path) -> None:
    manager = Manager(str(tmp_path / "notify"))
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT_FILES],
        env=os.environ | manager.environment(),
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == "cannot read how much memory it takes: Too many open files\n"
    assert manager.heard() == ["READY=1", "WATCHDOG=1"]
    manager.close()
