"""What Prometheus reads of a rig that runs, and where."""

import signal
import socket
import urllib.error
import urllib.request

import psutil
import pytest
from hub_site import made_site, start_hub
from manager_stand_in import Manager
from running_rig import Process, RunningRig, eventually

from inhand.__main__ import main

pytestmark = pytest.mark.long

RECORDERS = '[recorder.disk]\nfolder = "disk"\n[recorder.spare]\nfolder = "spare"'
DISK = '{daemon="disk",service="recorder"}'
SPARE = '{daemon="spare",service="recorder"}'


def _free_port() -> int:
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        port: int = server.getsockname()[1]
        return port


def _served(rig: RunningRig, port: int, **env: str) -> Process:
    metrics = rig.inhand("metrics", "--config", rig.config, "--port", str(port), **env)
    metrics.said(f"http://127.0.0.1:{port}/metrics")
    return metrics


def _read(port: int) -> dict[str, float]:
    """Every sample by its name and labels, which are in the order of the alphabet."""
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics", timeout=10) as answer:
        lines = answer.read().decode().splitlines()
    split = [line.rpartition(" ") for line in lines if not line.startswith("#")]
    samples: dict[str, float] = {}
    for name, _, value in split:
        metric, _, labels = name.rstrip("}").partition("{")
        ordered = ",".join(sorted(labels.split(",")))
        sample = f"{metric}{{{ordered}}}" if labels else metric
        assert sample not in samples
        samples[sample] = float(value)
    return samples


def test_the_health_of_who_runs_and_the_lack_of_who_does_not(rig: RunningRig) -> None:
    rig.configure(RECORDERS)
    port = _free_port()
    _served(rig, port)
    eventually("both are down", lambda: _read(port).get(f"inhand_instance_up{SPARE}") == 0)
    rig.inhand("recorder", "--config", rig.config, "--name", "disk").said("recorder disk is up")
    eventually("disk is up", lambda: _read(port)[f"inhand_instance_up{DISK}"] == 1)
    rig.publisher("--frames", "20")
    key = '{daemon="disk",name="front",service="recorder",stream="rgbd"}'
    received = f"inhand_messages_received_total{key}"
    eventually("frames", lambda: _read(port).get(received) == 20)
    samples = _read(port)
    state = '{daemon="disk",service="recorder",state="running"}'
    assert samples[f"inhand_instance_state{state}"] == 1
    assert samples[f"inhand_instance_resident_bytes{DISK}"] > 1e6
    assert samples[f"inhand_instance_loop_age_seconds{DISK}"] < 3
    assert samples[f"inhand_messages_lost_total{key}"] == 0
    assert samples[f"inhand_instance_up{SPARE}"] == 0
    assert samples["inhand_problems"] == 1
    assert samples["inhand_connected"] == 1
    assert f"inhand_instance_uptime_seconds{SPARE}" not in samples


def test_one_that_is_stopped_is_down(rig: RunningRig) -> None:
    rig.configure(RECORDERS)
    port = _free_port()
    _served(rig, port)
    disk = rig.inhand("recorder", "--config", rig.config, "--name", "disk")
    eventually("disk is up", lambda: _read(port)[f"inhand_instance_up{DISK}"] == 1)
    disk.popen.send_signal(signal.SIGSTOP)
    eventually("it is down", lambda: _read(port)[f"inhand_instance_up{DISK}"] == 0)
    assert _read(port)[f"inhand_instance_health_age_seconds{DISK}"] > 3
    disk.popen.send_signal(signal.SIGCONT)
    eventually("it is up again", lambda: _read(port)[f"inhand_instance_up{DISK}"] == 1)


def test_only_this_machine_reaches_it_and_systemd_is_told(rig: RunningRig) -> None:
    manager, port = Manager(str(rig.folder / "notify")), _free_port()
    metrics = _served(rig, port, **manager.environment())
    listening = [
        one.laddr.ip
        for one in psutil.Process(metrics.pid).net_connections(kind="inet")
        if one.status == psutil.CONN_LISTEN and one.laddr.port == port
    ]
    assert listening == ["127.0.0.1"]
    # A page of a site elsewhere, whose name points to this machine.
    for host in ("elsewhere.example", f"elsewhere.example:{port}", ""):
        asked = urllib.request.Request(f"http://127.0.0.1:{port}/metrics", headers={"Host": host})
        with pytest.raises(urllib.error.HTTPError, match="421"):
            urllib.request.urlopen(asked, timeout=10)
    eventually("it is up", lambda: manager.beats() > 4)
    assert metrics.stop() == 0
    assert (manager.heard()[0], manager.heard()[-1]) == ("READY=1", "STOPPING=1")
    manager.close()


def test_a_viewer_of_a_hub_reads_the_same_and_says_when_the_hub_is_away(rig: RunningRig) -> None:
    site, port = start_hub(rig, made_site(rig.folder / "site")), _free_port()
    metrics = rig.inhand("metrics", "--config", site.config("anna"), "--port", str(port))
    metrics.said(f"http://127.0.0.1:{port}/metrics")
    up = 'inhand_instance_up{daemon="hub",service="hub"}'
    eventually("the hub is up", lambda: _read(port).get(up) == 1)
    # The hub shows itself in the other rig as well, which is no second sample of the same labels.
    key = '{daemon="hub",name="home/@v1/garage/health/hub",service="hub",stream=""}'
    eventually("its traffic", lambda: f"inhand_messages_published_total{key}" in _read(port))
    assert _read(port)["inhand_connected"] == 1
    assert site.hub.stop() == 0
    eventually("nothing can be heard", lambda: _read(port)["inhand_connected"] == 0)


def test_a_port_that_is_taken_is_one_line(
    rig: RunningRig, capsys: pytest.CaptureFixture[str]
) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        assert main(["metrics", "--config", str(rig.config), "--port", port]) == 2
    assert f"cannot listen at port {port}" in capsys.readouterr().err
