"""Children that end, and what is said of it."""

import logging
import sys
import time
from pathlib import Path

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


BEATS = """
import os, time
from inhand_runtime.service_manager import ServiceManager
manager, parent = ServiceManager(), os.getppid()
for _ in range({rounds}):
    if os.getppid() != parent:
        break
    manager.advanced()
    manager.status("said by another thread")
    time.sleep(0.02)
for number in range(1000):
    manager.status(f"still said {{number}}")
    time.sleep(0.02)
"""
OF_ANOTHER = """
import subprocess, sys, time
subprocess.Popen([sys.executable, "-c", {script!r}], stdout=subprocess.DEVNULL).wait()
"""


WRONG_LATER = """
import sys, time
from pathlib import Path
from inhand_runtime.service_manager import ServiceManager
if Path({file!r}).exists():
    sys.exit(2)
Path({file!r}).touch()
manager = ServiceManager()
for _ in range(50):
    manager.advanced()
    time.sleep(0.02)
sys.exit(1)
"""


def test_a_child_that_was_up_is_started_again_where_its_settings_are_wrong_later(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    script = WRONG_LATER.format(file=str(tmp_path / "was_up"))
    child = Child("tracker mug", [sys.executable, "-c", script])
    codes: list[int] = []
    while len(codes) < 2:
        if (code := child.tend()) is not None:
            codes.append(code)
        child.kill_if_it_hangs()
        time.sleep(0.01)
    assert codes == [1, 2]
    assert not child.done
    assert "tracker mug ended with exit code 2; starting it again" in caplog.text


def test_a_child_that_starts_with_wrong_settings_is_not_started_again() -> None:
    child = Child("tracker mug", [sys.executable, "-S", "-c", "raise SystemExit(2)"])
    while child.tend() is None:
        time.sleep(0.01)
    assert child.done


def _tended(script: str, seconds: float) -> tuple[bool, bool]:
    """Whether a child was ever up, and whether it was killed, within so many seconds."""
    child = Child("recorder disk", [sys.executable, "-c", script])
    was_up = False
    end = time.monotonic() + seconds
    try:
        while time.monotonic() < end:
            if child.tend() is not None:
                return was_up, True
            child.kill_if_it_hangs()
            was_up |= child.is_up
            time.sleep(0.01)
    finally:
        child.kill()
    return was_up, False


@pytest.fixture
def hangs_soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """A child hangs after a second already."""
    monkeypatch.setattr("inhand.child.HANGS_AFTER_S", 1.0)


@pytest.mark.usefixtures("hangs_soon")
def test_a_child_whose_work_comes_round_no_more_is_killed_whatever_its_other_threads_say(
    caplog: pytest.LogCaptureFixture,
) -> None:
    assert _tended(BEATS.format(rounds=10), 30.0) == (True, True)
    assert "recorder disk has not come round for 1 s: it hangs, and is killed" in caplog.text


@pytest.mark.usefixtures("hangs_soon")
def test_a_child_whose_work_comes_round_lives_on() -> None:
    assert _tended(BEATS.format(rounds=1000), 4.0) == (True, False)


@pytest.mark.usefixtures("hangs_soon")
def test_a_child_that_takes_long_to_begin_is_not_killed() -> None:
    assert _tended("import time; time.sleep(60)", 3.0) == (False, False)


@pytest.mark.usefixtures("hangs_soon")
def test_what_a_child_has_started_does_not_speak_for_it() -> None:
    script = OF_ANOTHER.format(script=BEATS.format(rounds=1000))
    assert _tended(script, 3.0) == (False, False)
