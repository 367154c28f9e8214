"""Lanes keep the newest, and the reader gets them in the order of arrival."""

import threading
import time

import pytest
from inhand_runtime.inbox import Inbox, Received


def _sample(key: str, number: int, size: int = 1) -> Received:
    return Received(key, bytes(size), "", number)


def _numbers(inbox: Inbox) -> list[int]:
    numbers = []
    while (sample := inbox.get(0)) is not None:
        numbers.append(sample.received_ns)
    return numbers


def test_lanes_are_read_in_the_order_of_arrival() -> None:
    inbox = Inbox()
    lanes = [inbox.lane(samples=10, on_drop=pytest.fail) for _ in range(2)]
    for number in range(6):
        lanes[number % 2].put(_sample("a", number))
    assert _numbers(inbox) == [0, 1, 2, 3, 4, 5]


def test_a_full_lane_drops_its_oldest_and_tells_the_key() -> None:
    inbox = Inbox()
    dropped: list[str] = []
    lane = inbox.lane(samples=2, on_drop=dropped.append)
    other = inbox.lane(samples=2, on_drop=pytest.fail)
    other.put(_sample("b", 0))
    for number in range(1, 6):
        lane.put(_sample("a", number))
    assert dropped == ["a", "a", "a"]
    assert _numbers(inbox) == [0, 4, 5]


def test_a_lane_is_bounded_in_bytes_but_keeps_the_newest_however_large() -> None:
    inbox = Inbox()
    dropped: list[str] = []
    lane = inbox.lane(samples=100, size=10, on_drop=dropped.append)
    for number in range(3):
        lane.put(_sample("a", number, size=5))
    assert len(dropped) == 1
    lane.put(_sample("a", 9, size=1000))
    assert _numbers(inbox) == [9]
    lane.put(_sample("a", 10, size=5))
    assert _numbers(inbox) == [10]


def test_an_empty_inbox_waits_no_longer_than_asked() -> None:
    begin = time.monotonic()
    assert Inbox().get(0.05) is None
    assert time.monotonic() - begin >= 0.05


def test_a_waiting_reader_wakes_on_arrival() -> None:
    inbox = Inbox()
    lane = inbox.lane(samples=1, on_drop=pytest.fail)
    writer = threading.Timer(0.02, lane.put, (_sample("a", 1),))
    writer.start()
    assert inbox.get(60) == _sample("a", 1)
    writer.join()


def test_a_closed_inbox_gives_what_is_queued_takes_no_more_and_wakes_the_reader() -> None:
    inbox = Inbox()
    lane = inbox.lane(samples=1, on_drop=pytest.fail)
    lane.put(_sample("a", 1))
    inbox.close()
    lane.put(_sample("a", 2))
    assert _numbers(inbox) == [1]
    assert inbox.get(60) is None
