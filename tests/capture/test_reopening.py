"""A lost source comes back; a broken one does not."""

import itertools
import threading
from collections.abc import Iterator

import pytest
from inhand_capture.reopening import captures, growing_pauses
from inhand_runtime.source import Captured, Source, SourceError
from scripted_source import FIRST_NS, FRAME_NS, ScriptedSource, Step


class Capture:
    """Runs a script and notes what happened."""

    def __init__(self, *script: Step) -> None:
        ScriptedSource.steps = list(script)
        ScriptedSource.published = 0
        self.stop = threading.Event()
        self.opened: list[Source] = []
        self.lost: list[str] = []
        self.pauses: list[int] = []

    def run(self) -> Iterator[Captured]:
        """The moments, with pauses that take no time."""
        return captures(
            lambda: ScriptedSource({}),
            lambda: True,
            self.stop,
            opened=self.opened.append,
            lost=lambda error: self.lost.append(str(error)),
            pauses=self._no_pauses,
        )

    def numbers(self) -> list[int]:
        """Which moments came."""
        return [(captured.time_ns - FIRST_NS) // FRAME_NS for captured in self.run()]

    def _no_pauses(self) -> Iterator[float]:
        for attempt in itertools.count(1):
            self.pauses.append(attempt)
            yield 0.0


def test_a_source_that_ends_ends_the_capture() -> None:
    capture = Capture(3)
    assert capture.numbers() == [0, 1, 2]
    assert (len(capture.opened), capture.lost) == (1, [])


def test_a_lost_source_is_opened_until_it_comes_back() -> None:
    capture = Capture(2, "lost", "closed", "closed", 2)
    assert capture.numbers() == [0, 1, 2, 3]
    assert len(capture.opened) == 2
    assert capture.lost == [
        "the scripted camera went away: plug it in again",
        "no scripted camera is connected",
        "no scripted camera is connected",
    ]


def test_pauses_grow_until_a_moment_comes() -> None:
    capture = Capture(1, "lost", "lost", "closed", 1, "lost", 1)
    assert capture.numbers() == [0, 1, 2]
    assert capture.pauses == [1, 2, 3, 1]


def test_pauses_grow_up_to_two_seconds() -> None:
    assert list(itertools.islice(growing_pauses(), 7)) == [0.5, 1, 2, 2, 2, 2, 2]


def test_a_source_that_cannot_be_opened_at_first_is_an_error() -> None:
    with pytest.raises(SourceError, match="no scripted camera is connected"):
        Capture("closed", 1).numbers()


def test_a_device_that_is_absent_at_first_is_waited_for() -> None:
    capture = Capture("absent", "absent", 2)
    assert capture.numbers() == [0, 1]
    assert capture.lost == ["the scripted camera is not plugged in"]


def test_absence_just_after_a_loss_is_a_restart_and_no_new_error(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for patience_s, told in ((15.0, 0), (-1.0, 2)):
        monkeypatch.setattr("inhand_capture.reopening.RESTARTS_WITHIN_S", patience_s)
        capture = Capture(1, "lost", "absent", "absent", 1)
        assert capture.numbers() == [0, 1]
        assert capture.lost.count("the scripted camera is not plugged in") == told


def test_while_a_source_opens_slowly_there_are_signs_of_life(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("inhand_capture.reopening.QUIET_S", 0.01)
    monkeypatch.setattr("inhand_capture.reopening.STOP_POLL_S", 0.01)
    capture = Capture(1)
    may_open = threading.Event()

    def slowly() -> ScriptedSource:
        may_open.wait()
        return ScriptedSource({})

    running = captures(
        slowly, lambda: True, capture.stop, opened=capture.opened.append, lost=capture.lost.append
    )
    assert [next(running), next(running)] == [None, None]
    may_open.set()
    assert any(captured is not None for captured in running)


def test_what_opens_after_a_stop_is_closed_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("inhand_capture.reopening.ENDS_OPENING_S", 0.01)
    capture = Capture(1)
    may_open, closed = threading.Event(), threading.Event()

    class Late(ScriptedSource):
        def close(self) -> None:
            closed.set()

    def slowly() -> ScriptedSource:
        may_open.wait()
        return Late({})

    capture.stop.set()
    running = captures(
        slowly, lambda: True, capture.stop, opened=capture.opened.append, lost=capture.lost.append
    )
    assert list(running) == []
    may_open.set()
    assert closed.wait(10)
    assert capture.opened == []


def test_a_broken_source_is_an_error() -> None:
    capture = Capture(2, "broken", 2)
    with pytest.raises(SourceError, match="broken"):
        capture.numbers()
    assert capture.lost == []


def test_a_stop_ends_a_source_that_hangs() -> None:
    capture = Capture(1, "hang", 1)
    running = capture.run()
    next(running)
    threading.Timer(0.02, capture.stop.set).start()
    assert list(running) == []


def test_a_stop_ends_the_wait_for_a_lost_source() -> None:
    capture = Capture(1, "lost", 1)
    running = captures(
        lambda: ScriptedSource({}),
        lambda: True,
        capture.stop,
        opened=capture.opened.append,
        lost=lambda _error: capture.stop.set(),
    )
    assert len(list(running)) == 1
