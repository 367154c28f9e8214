"""What a daemon tells systemd, over the socket that systemd would give it."""

import itertools
import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from inhand_runtime.service_manager import ServiceManager, without_manager
from inhand_schemas.messages import Skeletons
from inhand_schemas.topics import SKELETONS
from manager_stand_in import WATCHDOG_S, Manager
from running_rig import Process, RunningRig, eventually
from wire import Wire

DAEMON = Path(__file__).with_name("small_daemon.py")


@pytest.fixture
def manager(tmp_path: Path) -> Iterator[Manager]:
    """A manager that listens at a file."""
    listening = Manager(str(tmp_path / "notify"))
    yield listening
    listening.close()


def _start(rig: RunningRig, manager: Manager, **env: str) -> Process:
    arguments = ("--config", rig.config, "--name", "small")
    return rig.python(DAEMON, *arguments, **manager.environment(), **env)


def test_a_service_is_up_with_its_first_round_and_alive_a_few_times_within_the_watchdog(
    manager: Manager,
) -> None:
    now = [10.0]
    service = ServiceManager(manager.environment(), lambda: now[0])
    assert manager.heard() == []
    for _ in range(100):
        service.advanced()
        now[0] += WATCHDOG_S / 50
    assert manager.heard()[0] == "READY=1"
    assert manager.heard().count("READY=1") == 1
    assert manager.beats() == 8


def test_a_status_is_one_line_of_bounded_length_and_said_when_it_is_new(manager: Manager) -> None:
    service = ServiceManager(manager.environment())
    for words in ("running", "running", "degraded; READY=1\nMAINPID=1", "x" * 5000):
        service.status(words)
    assert manager.heard()[:2] == ["STATUS=running", "STATUS=degraded; READY=1 MAINPID=1"]
    assert len(manager.heard()) == 3
    assert len(manager.heard()[2]) < 600


def test_a_name_that_no_file_stands_for_is_reached() -> None:
    listening = Manager(f"@inhand-test-{os.getpid()}")
    ServiceManager(listening.environment()).advanced()
    assert listening.heard() == ["READY=1", "WATCHDOG=1"]
    listening.close()


@pytest.mark.parametrize(
    "changed",
    [{"WATCHDOG_PID": "1"}, {"WATCHDOG_USEC": "0"}, {"WATCHDOG_USEC": "soon"}],
    ids=["another process's", "never", "no number"],
)
def test_a_watchdog_that_is_not_ours_is_not_fed(manager: Manager, changed: dict[str, str]) -> None:
    service = ServiceManager(manager.environment() | changed)
    for _ in range(10):
        service.advanced()
    assert manager.heard() == ["READY=1"]


def test_nobody_is_spoken_to_where_nobody_listens(tmp_path: Path) -> None:
    for environment in ({}, {"NOTIFY_SOCKET": str(tmp_path / "gone"), "WATCHDOG_USEC": "1000000"}):
        service = ServiceManager(environment)
        service.advanced()
        service.status("running")
        service.stopping()


def test_a_child_does_not_speak_for_its_parent(manager: Manager) -> None:
    environment = manager.environment() | {"WATCHDOG_PID": "7", "PATH": "/bin"}
    assert without_manager(environment) == {"PATH": "/bin"}


@pytest.mark.long
def test_a_daemon_is_up_then_alive_says_how_it_is_and_that_it_ends(
    rig: RunningRig, wire: Wire, manager: Manager
) -> None:
    daemon = _start(rig, manager)
    eventually("it is up", lambda: "READY=1" in manager.heard())
    eventually("its state", lambda: "STATUS=running" in manager.heard())
    publisher = wire.publisher(SKELETONS, "front")
    eventually("the reader", publisher.wanted)
    key = SKELETONS.key(wire.site, "front")
    wire.session.put(key, b"\xc1", encoding=SKELETONS.encoding)
    publisher.put(Skeletons(sequence=7, time_ns=1))
    eventually(
        "its trouble in words",
        lambda: any(one.startswith("STATUS=degraded; ") and key in one for one in manager.heard()),
    )
    fed = manager.beats()
    eventually("it goes on", lambda: manager.beats() >= fed + 4)
    daemon.stop()
    assert manager.heard()[-2:].count("STOPPING=1") == 1
    assert [one for one, _ in itertools.groupby(manager.heard())].count("READY=1") == 1


@pytest.mark.long
def test_the_watchdog_starves_while_the_main_loop_hangs_though_the_health_goes_on(
    rig: RunningRig, wire: Wire, manager: Manager
) -> None:
    daemon = _start(rig, manager, INHAND_TRACKER__SMALL__STUCK="true")
    eventually("it is alive", lambda: manager.beats() >= 2)
    daemon.popen.send_signal(signal.SIGTERM)
    daemon.said("does not care")
    fed = manager.beats()
    time.sleep(2 * WATCHDOG_S)
    assert manager.beats() == fed
    assert daemon.popen.poll() is None
