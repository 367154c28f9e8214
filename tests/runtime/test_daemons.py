"""The life of a daemon, as a process over real Zenoh."""

import itertools
import json
import signal
import socket
import time
from pathlib import Path
from statistics import median

from inhand_runtime.inbox import Received
from inhand_schemas.messages import Health, Skeletons
from inhand_schemas.topics import HEALTH, SKELETONS
from running_rig import Process, RunningRig, eventually
from wire import Wire

DAEMON = Path(__file__).with_name("small_daemon.py")
STOPS_WITHIN_S = 2.0


def _start(rig: RunningRig, name: str = "small", **env: str) -> Process:
    daemon = rig.python(DAEMON, "--config", rig.config, "--name", name, **env)
    daemon.said(f"tracker {name} is up")
    return daemon


def _last_health(heard: list[Received]) -> Health:
    return HEALTH.decode(heard[-1].payload, heard[-1].encoding)


def test_sigterm_ends_a_daemon_cleanly_within_two_seconds(rig: RunningRig) -> None:
    daemon = _start(rig)
    begin = time.monotonic()
    assert daemon.stop(signal.SIGTERM) == 0
    assert time.monotonic() - begin < STOPS_WITHIN_S
    assert "tracker small stopped" in daemon.stderr


def test_ctrl_c_ends_a_daemon_without_a_traceback(rig: RunningRig) -> None:
    daemon = _start(rig)
    assert daemon.stop(signal.SIGINT) == 0
    assert "Traceback" not in daemon.stderr


def test_a_second_signal_ends_a_stuck_daemon_at_once(rig: RunningRig) -> None:
    daemon = _start(rig, INHAND_TRACKER__SMALL__STUCK="true")
    daemon.popen.send_signal(signal.SIGTERM)
    daemon.said("does not care")
    begin = time.monotonic()
    assert daemon.stop(signal.SIGTERM) == 128 + signal.SIGTERM
    assert time.monotonic() - begin < STOPS_WITHIN_S


def test_an_instance_is_live_until_it_ends_or_is_killed(wire: Wire, rig: RunningRig) -> None:
    ending, killed = _start(rig, "ending"), _start(rig, "killed")
    eventually("both tokens", lambda: wire.live() == ["tracker/ending", "tracker/killed"])
    ending.stop()
    eventually("one token", lambda: wire.live() == ["tracker/killed"])
    killed.stop(signal.SIGKILL)
    eventually("no token", lambda: wire.live() == [])


def test_health_comes_once_a_second_and_a_last_time_at_the_end(wire: Wire, rig: RunningRig) -> None:
    heard = wire.hear(HEALTH)
    daemon = _start(rig)
    eventually("four reports", lambda: len(heard) >= 4)
    reports = [HEALTH.decode(each.payload, each.encoding) for each in heard]
    gaps = [b.time_ns - a.time_ns for a, b in itertools.pairwise(reports)]
    assert 0.9e9 < median(gaps) < 1.5e9
    assert {report.state for report in reports} == {"running"}
    assert reports[-1].resident_bytes > 1_000_000
    daemon.stop()
    eventually("the last words", lambda: _last_health(heard).state == "stopping")


def test_malformed_messages_are_counted_and_logged_once_and_the_daemon_lives_on(
    wire: Wire, rig: RunningRig
) -> None:
    health = wire.hear(HEALTH)
    daemon = _start(rig)
    key = SKELETONS.key(wire.site, "front")
    publisher = wire.publisher(SKELETONS, "front")
    eventually("the reader", publisher.wanted)
    for number in range(5):
        wire.session.put(key, b"\xc1" * number, encoding=SKELETONS.encoding)
    publisher.put(Skeletons(sequence=7, time_ns=1))
    daemon.said("got 7")
    eventually("a report", lambda: health and key in _last_health(health).topics)
    eventually("the count", lambda: _last_health(health).topics[key].malformed == 5)
    assert _last_health(health).topics[key].received == 1
    assert daemon.stderr.count("dropped a message") == 1


def test_a_message_of_an_unknown_version_is_named_clearly(wire: Wire, rig: RunningRig) -> None:
    daemon = _start(rig)
    publisher = wire.publisher(SKELETONS, "front")
    eventually("the reader", publisher.wanted)
    key = SKELETONS.key(wire.site, "front")
    wire.session.put(key, b"\x80", encoding="application/msgpack;Skeletons.v2")
    daemon.said("Skeletons comes in version 2, and this release reads version 1: update the older")


def test_a_lonely_daemon_says_so_once(rig: RunningRig) -> None:
    daemon = _start(rig)
    daemon.said("no other process is connected yet; those that run meet at zenoh.meeting")
    daemon.stop()
    assert daemon.stderr.count("no other process") == 1


def test_a_daemon_with_company_does_not_complain(wire: Wire, rig: RunningRig) -> None:
    health = wire.hear(HEALTH)
    daemon = _start(rig)
    eventually("five reports", lambda: len(health) >= 5)
    daemon.stop()
    assert "no other process" not in daemon.stderr


def test_a_foreign_program_at_the_meeting_address_is_hinted_at(rig: RunningRig) -> None:
    port = int(rig.meeting.rsplit(":", 1)[1])
    with socket.create_server(("127.0.0.1", port)):
        daemon = _start(rig)
        daemon.said("no foreign program holds that port")
        begin = time.monotonic()
        assert daemon.stop() == 0
        assert time.monotonic() - begin < STOPS_WITHIN_S


def test_a_port_in_use_ends_a_daemon_with_one_line(rig: RunningRig) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        address = f"tcp/127.0.0.1:{other.getsockname()[1]}"
        daemon = rig.python(DAEMON, "--config", rig.config, INHAND_ZENOH__LISTEN=f'["{address}"]')
        assert daemon.wait() == 2
    assert daemon.stderr == (
        f"tracker: cannot listen on {address}: the port is in use, or the address is not of this "
        "machine; change zenoh.listen\n"
    )


def test_a_client_without_a_hub_ends_with_one_line(rig: RunningRig) -> None:
    daemon = rig.python(
        DAEMON,
        "--config",
        rig.config,
        INHAND_ZENOH__MODE="client",
        INHAND_ZENOH__CONNECT=f'["{rig.meeting}"]',
    )
    assert daemon.wait() == 1
    assert daemon.stderr.startswith(f"tracker: no hub answers at {rig.meeting}: check that it runs")
    assert daemon.stderr.count("\n") == 1


def test_json_logs_are_one_object_a_line(rig: RunningRig) -> None:
    daemon = _start(rig, INHAND_LOG__FORMAT="json")
    daemon.stop()
    lines = [json.loads(line) for line in daemon.stderr.splitlines()]
    assert [line["message"] for line in lines] == ["tracker small is up", "tracker small stopped"]
    assert {line["level"] for line in lines} == {"info"}
