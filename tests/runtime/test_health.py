"""What an instance tells about itself."""

import logging
import time

import pytest
from inhand_runtime.health import MOST_KEYS, HealthBoard
from inhand_schemas.errors import MessageError
from inhand_schemas.topics import HEALTH


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
