"""Children that end, and what is said of it."""

import logging
import sys
import time
from collections.abc import Sequence

import pytest

from inhand.child import LOOP_FAILURES, Child
from inhand.last_words import how_it_ended

FAILS = "import sys; print('before', file=sys.stderr); raise ZeroDivisionError('a bug')"
KILLED = "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"


def _run(child: Child, times: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a child end so often, without the pauses between its starts."""
    monkeypatch.setattr("inhand.child.FIRST_RESTART_S", 0.0)
    monkeypatch.setattr("inhand.child.LAST_RESTART_S", 0.0)
    child._delay = 0.0
    ended = 0
    while ended < times:
        ended += child.tend() is not None
        time.sleep(0.005)


@pytest.mark.parametrize(
    ("script", "said"),
    [
        (FAILS, "ended with exit code 1: ZeroDivisionError: a bug; starting it again"),
        (KILLED, "was killed by SIGSEGV; starting it again"),
        ("import sys; sys.exit(7)", "ended with exit code 7; starting it again"),
    ],
)
def test_how_a_child_died_is_said_with_what_it_said_last(
    script: str,
    said: str,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
    capfdbinary: pytest.CaptureFixture[bytes],
) -> None:
    _run(Child("tracker mug", [sys.executable, "-c", script]), 1, monkeypatch)
    assert f"tracker mug {said}" in caplog.text
    if script is FAILS:
        assert b"before" in capfdbinary.readouterr().err


def test_a_child_that_ends_again_and_again_is_an_alert_once(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    child = Child("capture front", [sys.executable, "-S", "-c", "raise SystemExit(1)"])
    _run(child, LOOP_FAILURES + 2, monkeypatch)
    alerts = [one for one in caplog.records if one.levelno == logging.ERROR]
    assert len(alerts) == 1
    assert f"capture front has ended {LOOP_FAILURES} times" in alerts[0].getMessage()


def test_a_lack_of_memory_is_named_where_it_may_be_the_reason() -> None:
    assert "lack of memory" in how_it_ended(-9, "")
    assert "memory" not in how_it_ended(-15, "")


def _silent(child: Child, hears: Sequence[bool], monkeypatch: pytest.MonkeyPatch) -> None:
    """Start a child, hear it twice, and then no more: a second for each of ``hears``."""
    now = [100.0]
    monkeypatch.setattr("inhand.child.time.monotonic", lambda: now[0])
    child.tend()
    for reports in (1, 2):
        child.kill_if_it_hangs(reports)
    for can_hear in hears:
        now[0] += 1.0
        child.kill_if_it_hangs(2, can_hear=can_hear)


@pytest.mark.parametrize(
    ("hears", "killed"),
    [([True] * 12, True), ([False] * 30, False), ([False] * 30 + [True] * 8, False)],
    ids=["silent", "the hub is away", "the hub was away"],
)
def test_a_silent_child_is_killed_but_not_where_nothing_could_be_heard(
    hears: list[bool],
    killed: bool,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    child = Child("recorder disk", ["sleep", "60"])
    try:
        _silent(child, hears, monkeypatch)
        assert ("it hangs, and is killed" in caplog.text) == killed
    finally:
        child.kill()
