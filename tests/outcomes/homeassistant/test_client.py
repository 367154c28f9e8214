"""What a real broker is told, in both directions, and over its ends."""

import gc
import json
import time
from collections.abc import Iterator
from dataclasses import replace
from datetime import date, datetime
from pathlib import Path

import pytest
from gated import certificate
from home_states import SHAPE, STATE, ZURICH, replace_shape, showing, without
from inhand_outcomes.homeassistant.state import HomeEvent
from mosquitto import Broker, Reader, mosquitto, slow_way
from running_rig import eventually

BASE = f"inhand/{SHAPE.node}"
CONFIG = f"homeassistant/device/{SHAPE.node}/config"
PAHO_LEAVES_SOCKETS = (
    "ignore:Exception ignored in. <ssl.SSLSocket:pytest.PytestUnraisableExceptionWarning"
)
"""paho-mqtt 2.2 does not close a socket on which TLS failed."""
SIP = HomeEvent("sip", datetime(2026, 11, 30, 9, tzinfo=ZURICH), "mug", None, {"volume_ml": 31.0})


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Broker]:
    with mosquitto(tmp_path_factory.mktemp("broker")) as broker:
        yield broker


@pytest.fixture
def broker(running: Broker) -> Iterator[Broker]:
    """The broker with nothing retained."""
    yield running
    reader = Reader(running)
    time.sleep(0.1)
    for topic in [topic for topic, payload in reader.retained.items() if payload]:
        reader.send(topic, b"", retain=True)
    reader.close()


@pytest.fixture
def reader(broker: Broker) -> Iterator[Reader]:
    reader = Reader(broker)
    yield reader
    reader.close()


def sips(reader: Reader) -> float | None:
    payload = reader.value("mug-sip-times/state")
    return json.loads(payload)["value"] if payload else None


def status(reader: Reader) -> bytes | None:
    return reader.value("/status")


def test_all_is_retained_but_events(broker: Broker, reader: Reader, tmp_path: Path) -> None:
    with showing(broker.port, tmp_path) as shown:
        eventually("the device", lambda: status(reader) == b"online")
        shown.handover.say([SIP])
        eventually("the sip", lambda: reader.value("mug-event/state"))
        late = Reader(broker)
        eventually(
            "what is retained", lambda: status(late) == b"online" and CONFIG in late.retained
        )
        assert sips(late) == 7
        assert late.retained[f"{BASE}/floor/state"] == STATE.floor_png
        assert late.value("mug-event/state") is None
        late.close()
        assert shown.troubles == ""
    eventually("a farewell", lambda: status(reader) == b"offline")


def test_a_new_state_goes_out_and_what_is_the_same_does_not(
    broker: Broker, reader: Reader, tmp_path: Path
) -> None:
    with showing(broker.port, tmp_path) as shown:
        eventually("the device", lambda: status(reader) == b"online")
        reader.came.clear()
        shown.handover.show(replace(STATE, totals={}), ())
        new, expires = {"mug-sip-times", "mug-sip-volume_ml"}, {"mug-in_use"}

        def came() -> set[str]:
            return {topic.split("/")[2] for topic, _, _ in reader.came}

        eventually("the new totals", lambda: came() >= new)
        assert sips(reader) == 0
        assert came() <= new | expires
        eventually("what expires", lambda: came() >= expires)


def test_home_assistant_that_starts_is_told_all_again(
    broker: Broker, reader: Reader, tmp_path: Path
) -> None:
    with showing(broker.port, tmp_path):
        eventually("the device", lambda: status(reader) == b"online")
        reader.came.clear()
        reader.send("homeassistant/status", "online")
        eventually("the device again", lambda: any(one[0] == CONFIG for one in reader.came))
        eventually("values again", lambda: any("mug-sip-times" in one[0] for one in reader.came))


def test_the_switch_and_the_button_reach_the_daemon(
    broker: Broker, reader: Reader, tmp_path: Path
) -> None:
    with showing(broker.port, tmp_path) as shown:
        eventually("the device", lambda: status(reader) == b"online")
        reader.send(f"{BASE}/pause/set", "ON")
        assert eventually("the pause", shown.pausing.take_wanted)
        assert shown.pausing.paused
        reader.send(f"{BASE}/pause/set", "OFF")
        assert eventually("its end", shown.pausing.take_wanted)
        assert not shown.pausing.paused
        reader.send(f"{BASE}/forget_today/set", "PRESS")
        eventually("the day", lambda: shown.forgotten == [date(2026, 11, 30)])


def test_what_strangers_send_as_commands_is_dropped_and_counted(
    broker: Broker, reader: Reader, tmp_path: Path
) -> None:
    reader.send(f"{BASE}/forget_today/set", "PRESS", retain=True)  # at each connection otherwise
    with showing(broker.port, tmp_path) as shown:
        eventually("the device", lambda: status(reader) == b"online")
        for payload in (b"on", b"\xff\x00", b"PRESS" * 100_000, b""):
            reader.send(f"{BASE}/pause/set", payload)
        for component in ("forget_today/../pause", "floor", "goal--drink-event"):
            reader.send(f"{BASE}/{component}/set", "PRESS")
        reader.send(f"{BASE}/status", "offline")
        eventually("it to say that it is there", lambda: status(reader) == b"online")

        def dropped() -> int:
            topics = shown.health.report().topics
            return topics["homeassistant/commands"].malformed if topics else 0

        eventually("all to be counted", lambda: dropped() == 7)
        assert (shown.pausing.take_wanted(), shown.forgotten) == (False, [])
    reader.send(f"{BASE}/forget_today/set", b"", retain=True)


def test_an_object_that_is_removed_goes_from_the_broker(
    broker: Broker, reader: Reader, tmp_path: Path
) -> None:
    with showing(broker.port, tmp_path):
        eventually("the device", lambda: status(reader) == b"online")
    reader.came.clear()
    with showing(broker.port, tmp_path, None) as shown:
        shown.handover.show(without(STATE, "mug"), (SHAPE,))
        eventually("the word", lambda: shown.handover.take_announced() is not None)
        eventually("the device", lambda: status(reader) == b"online")
        first, last = (
            json.loads(payload)["components"]
            for topic, payload, _ in reader.came
            if topic == CONFIG
        )
        assert first["mug-sip-volume_ml"] == {"platform": "sensor"}
        assert not [name for name in last if name.startswith("mug")]
        late = Reader(broker)
        eventually("what is retained", lambda: status(late) == b"online")
        assert not [topic for topic in late.retained if "mug" in topic]
        late.close()


def test_single_components_replace_the_device_and_go_with_their_object(
    broker: Broker, reader: Reader, tmp_path: Path
) -> None:
    single = replace_shape(SHAPE, single_components=True)
    with showing(broker.port, tmp_path):
        eventually("the device", lambda: status(reader) == b"online")
    with showing(broker.port, tmp_path, None) as shown:
        shown.handover.show(replace(STATE, shape=single), (SHAPE,))
        eventually("the device's end", lambda: reader.retained[CONFIG] == b"")
        topic = f"homeassistant/sensor/{SHAPE.node}/mug-sip-volume_ml/config"
        assert json.loads(reader.retained[topic])["device_class"] == "volume"
        shown.handover.show(without(replace(STATE, shape=single), "mug"), (single,))
        eventually("its end", lambda: reader.retained[topic] == b"")


@pytest.mark.long
def test_a_broker_that_restarts_has_all_again(tmp_path: Path) -> None:
    """Alone it shows that the client comes back by itself."""
    with mosquitto(tmp_path / "broker") as broker, showing(broker.port, tmp_path) as shown:
        eventually("the device", lambda: shown.troubles == "" and shown.handover.take_announced())
        broker.stop()
        eventually("the trouble", lambda: "cannot be reached" in shown.troubles)
        (broker.folder / "mosquitto.db").unlink()
        shown.handover.show(replace(STATE, totals={}), ())
        broker.start()
        eventually("the way back", lambda: shown.troubles == "")
        reader = Reader(broker)
        eventually("the device", lambda: status(reader) == b"online")
        assert sips(reader) == 0
        reader.close()


def test_a_wrong_password_is_said_with_the_mend(broker: Broker, tmp_path: Path) -> None:
    with showing(broker.port, tmp_path, password="wrong") as shown:
        eventually("the trouble", lambda: "change user and password_file" in shown.troubles)


@pytest.mark.filterwarnings(PAHO_LEAVES_SOCKETS)
def test_a_broker_whose_certificate_is_known_is_told_all(tmp_path: Path) -> None:
    made = certificate(tmp_path)
    (tmp_path / "other").mkdir()
    other = certificate(tmp_path / "other")
    with mosquitto(tmp_path / "broker", made) as broker:
        with showing(broker.port, tmp_path, authority=made["certificate"]) as shown:
            eventually("the word", lambda: shown.handover.take_announced() is not None)
        with showing(broker.port, tmp_path, authority=other["certificate"]) as shown:
            eventually("the trouble", lambda: "certificate that is not trusted" in shown.troubles)
        with showing(broker.port, tmp_path, tls=True) as shown:  # the system's authorities
            eventually("the trouble", lambda: "certificate that is not trusted" in shown.troubles)
    gc.collect()


def test_a_slow_broker_gets_the_newest_state_and_stalls_nobody(
    broker: Broker, reader: Reader, tmp_path: Path
) -> None:
    speed = [20_000.0]
    with (
        slow_way(broker.port, lambda: speed[0]) as port,
        showing(port, tmp_path) as shown,
    ):
        began = time.monotonic()
        for times in range(1000):
            total = replace(STATE.totals["mug", "sip"], times=times)
            shown.handover.show(replace(STATE, totals={("mug", "sip"): total}), ())
        assert time.monotonic() - began < 1.0
        speed[0] = 1e6
        eventually("the newest", lambda: sips(reader) == 999)
        assert len([one for one in reader.came if "mug-sip-times" in one[0]]) < 10
