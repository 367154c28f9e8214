"""Of two daemons of one name one lives, whoever sees whom when."""

import signal
from pathlib import Path

import psutil
import pytest
from inhand_runtime.session import open_session
from inhand_runtime.settings import ZenohSettings
from running_rig import Process, RunningRig, eventually
from twins import ONE_UP, WAYS, outcomes

SMALL_DAEMON = Path(__file__).parents[1] / "runtime" / "small_daemon.py"


def _small(rig: RunningRig, meeting: str) -> Process:
    arguments = ("--config", rig.config, "--name", "small")
    daemon = rig.python(SMALL_DAEMON, *arguments, INHAND_ZENOH__MEETING=meeting)
    daemon.said("is up")
    return daemon


def test_one_of_two_starts_however_they_come() -> None:
    trials = list(outcomes(len(WAYS), seed=1))
    assert trials == [(way, ONE_UP) for way in WAYS]


@pytest.mark.long
def test_one_of_two_starts_each_time() -> None:
    assert {outcome for _, outcome in outcomes(3 * len(WAYS), seed=2)} == {ONE_UP}


def test_of_two_that_meet_late_the_younger_ends_with_a_clear_line(
    rig: RunningRig, tmp_path_factory: pytest.TempPathFactory
) -> None:
    elsewhere = RunningRig(tmp_path_factory.mktemp("elsewhere"))
    elder, younger = (_small(rig, meeting) for meeting in (rig.meeting, elsewhere.meeting))
    with open_session(ZenohSettings(meeting=rig.meeting, connect=(elsewhere.meeting,))):
        assert younger.wait() == 1
    assert "another tracker small was up earlier in rig 'rig' of realm 'inhand'" in younger.stderr
    assert "this one ends; give one of them another name" in younger.stderr.splitlines()[-1]
    assert "stopped" not in elder.stderr
    assert elder.stop() == 0


@pytest.mark.long
def test_when_a_stopped_daemon_goes_on_the_one_started_meanwhile_ends(rig: RunningRig) -> None:
    stopped = _small(rig, rig.meeting)
    stopped.popen.send_signal(signal.SIGSTOP)
    meanwhile = _small(rig, rig.meeting)
    stopped.popen.send_signal(signal.SIGCONT)
    assert meanwhile.wait() == 1
    assert "was up earlier" in meanwhile.stderr
    assert stopped.stop() == 0


def test_a_signal_ends_a_daemon_that_still_waits_for_its_name(rig: RunningRig) -> None:
    daemon = rig.python(SMALL_DAEMON, "--config", rig.config)
    eventually("the address", lambda: _listens(rig.meeting))
    assert daemon.stop() == 0


def _listens(meeting: str) -> bool:
    port = int(meeting.rsplit(":", 1)[1])
    return any(one.laddr.port == port for one in psutil.net_connections("tcp"))
