"""A daemon of outcomes in a rig beside a broker: what both see of each other."""

import json
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from carried_cup import write_model
from mosquitto import Broker, Reader, mosquitto
from running_rig import Process, RunningRig, eventually

pytestmark = pytest.mark.long
CARRYING = Path(__file__).parents[2] / "scenes" / "carrying_publisher.py"


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[RunningRig]:
    rig = RunningRig(tmp_path)
    yield rig
    rig.close()


def start(rig: RunningRig, broker: Broker) -> Process:
    model = write_model(rig.folder / "cup.model")
    rig.configure(f'[outcomes.home]\nmodels = ["{model}"]\ntime_zone = "UTC"\n{broker.settings()}')
    daemon = rig.inhand("outcomes", "--config", rig.config)
    daemon.said("is up")
    return daemon


def carry(rig: RunningRig, number: int) -> None:
    start_ns = time.time_ns() - (60 - 12 * number) * 10**9
    publisher = rig.python(
        CARRYING, "--meeting", rig.meeting, "--start-ns", str(start_ns), "--speed", "6"
    )
    assert publisher.wait() == 0, publisher.stderr


def test_pausing_and_forgetting_reach_what_is_kept(rig: RunningRig) -> None:
    """Alone it shows the whole way from a broker to the store and back, over a restart."""
    with mosquitto(rig.folder / "broker") as broker:
        daemon = start(rig, broker)
        reader = Reader(broker)

        def put_down() -> int | None:
            payload = reader.value("cup-put_down-times/state")
            return int(json.loads(payload)["value"]) if payload else None

        eventually("the device", lambda: put_down() == 0)
        carry(rig, 0)
        eventually("the cup", lambda: put_down() == 1)
        node = next(topic for topic in reader.retained if topic.endswith("/status")).split("/")[1]
        paused = rig.done("outcomes", "pause", "--config", rig.config)
        assert (paused.popen.returncode, paused.stdout) == (
            0,
            "home: paused: nothing is measured\n",
        )
        eventually("the pause", lambda: reader.value("/pause/state") == b"ON")
        carry(rig, 1)
        assert daemon.stop() == 0
        eventually("the farewell", lambda: reader.value("/status") == b"offline")
        start(rig, broker)
        eventually("the daemon", lambda: reader.value("/status") == b"online")
        status = rig.done("status", "--config", rig.config, "--seconds", "10")
        assert "nothing is measured until `inhand outcomes resume --name home`" in status.stdout
        assert (put_down(), reader.value("/pause/state")) == (1, b"ON")
        reader.send(f"inhand/{node}/pause/set", "OFF")
        eventually("the pause's end", lambda: reader.value("/pause/state") == b"OFF")
        reader.send(f"inhand/{node}/forget_today/set", "PRESS")
        eventually("nothing", lambda: put_down() == 0)
        reader.close()
