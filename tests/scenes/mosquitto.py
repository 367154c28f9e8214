"""A real MQTT broker, for the tests alone: with users, with TLS, slow, or gone for a while."""

import os
import shutil
import socket
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

import paho.mqtt.client as mqtt
import pytest
from paho.mqtt.enums import CallbackAPIVersion
from running_rig import eventually, free_port

REQUIRED = "MOSQUITTO_REQUIRED"
"""Set where a machine without mosquitto is a fault, as in CI."""
USER, PASSWORD = "inhand", "a password of the tests"


@dataclass
class Broker:
    """A broker on a port of loopback, whose retained messages stay when it is started again."""

    folder: Path
    certificate: dict[str, Path] | None = None
    port: int = field(default_factory=free_port)
    _process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Listen; the test is skipped where mosquitto is not installed."""
        program = _program()
        passwords = self.folder / "passwords"
        if not passwords.exists():
            with_user = ("mosquitto_passwd", "-b", "-c", passwords, USER, PASSWORD)
            subprocess.run(with_user, check=True, capture_output=True)
        lines = [f"listener {self.port} 127.0.0.1", "allow_anonymous false"]
        lines += [f"password_file {passwords}", "user root"]
        lines += ["persistence true", f"persistence_location {self.folder}/", "autosave_interval 1"]
        lines += ["autosave_on_changes true"]
        if self.certificate is not None:
            lines += [f"certfile {self.certificate['certificate']}"]
            lines += [f"keyfile {self.certificate['private_key']}"]
        config = self.folder / "mosquitto.conf"
        config.write_text("\n".join(lines) + "\n")
        with (self.folder / "mosquitto.log").open("ab") as log:
            command = [program, "-v", "-c", str(config)]
            self._process = subprocess.Popen(command, stdout=log, stderr=log)
        eventually("the broker to listen", self._listens)

    def stop(self) -> None:
        """End it."""
        if self._process is not None:
            self._process.terminate()
            self._process.wait(10.0)
            self._process = None

    def settings(self, **others: str | int | bool) -> str:
        """The table by which a daemon reaches it."""
        password = self.folder / "password"
        password.write_text(PASSWORD + "\n")
        values = {
            "host": "127.0.0.1",
            "port": self.port,
            "user": USER,
            "password_file": str(password),
            **others,
        }
        texts = {True: "true", False: "false"}
        lines = [
            f"{name} = {texts[value] if isinstance(value, bool) else repr(value)}"
            for name, value in values.items()
        ]
        return "[outcomes.home.homeassistant]\n" + "\n".join(lines).replace("'", '"') + "\n"

    def _listens(self) -> bool:
        assert self._process is not None
        log = (self.folder / "mosquitto.log").read_text()
        assert self._process.poll() is None, log
        with suppress(OSError), socket.create_connection(("127.0.0.1", self.port), 1.0):
            return True
        return False


class Reader:
    """Who reads all that a broker has, and sends what tests want."""

    def __init__(self, broker: Broker, filters: tuple[str, ...] = ("#",)) -> None:
        self.retained: dict[str, bytes] = {}
        """The newest payload of each topic that was retained, or came since."""
        self.came: list[tuple[str, bytes, bool]] = []
        """All that came: topic, payload, and whether it was retained before."""
        self._client = mqtt.Client(CallbackAPIVersion.VERSION2)
        self._client.username_pw_set(USER, PASSWORD)
        if broker.certificate is not None:
            self._client.tls_set(ca_certs=str(broker.certificate["certificate"]))
        self._client.on_message = self._take
        connected = threading.Event()
        self._client.on_subscribe = lambda *_: connected.set()
        self._client.on_connect = lambda client, *_: client.subscribe([(one, 1) for one in filters])
        self._client.connect("127.0.0.1", broker.port)
        self._client.loop_start()
        assert connected.wait(20.0)

    def send(self, topic: str, payload: bytes | str, *, retain: bool = False) -> None:
        """Publish something, and see that the broker has it."""
        self._client.publish(topic, payload, 1, retain).wait_for_publish(20.0)

    def value(self, topic: str) -> bytes | None:
        """The newest payload of the topic that ends so."""
        return next((one for name, one in self.retained.items() if name.endswith(topic)), None)

    def close(self) -> None:
        """Leave."""
        self._client.disconnect()
        self._client.loop_stop()

    def _take(self, _client: mqtt.Client, _data: object, message: mqtt.MQTTMessage) -> None:
        payload = bytes(message.payload)
        self.came.append((message.topic, payload, message.retain))
        self.retained[message.topic] = payload


@contextmanager
def mosquitto(folder: Path, certificate: dict[str, Path] | None = None) -> Iterator[Broker]:
    """Run a broker until the block ends."""
    folder.mkdir(exist_ok=True)
    broker = Broker(folder, certificate)
    broker.start()
    try:
        yield broker
    finally:
        broker.stop()


@contextmanager
def slow_way(port: int, bytes_per_s: Callable[[], float]) -> Iterator[int]:
    """Yield a port that leads to another one, by so many bytes a second in each direction."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        thread = threading.Thread(target=_lead, args=(server, port, bytes_per_s), daemon=True)
        thread.start()
        yield server.getsockname()[1]


def _lead(server: socket.socket, port: int, bytes_per_s: Callable[[], float]) -> None:
    with suppress(OSError):
        while True:
            near, _ = server.accept()
            far = socket.create_connection(("127.0.0.1", port))
            for pair in ((near, far), (far, near)):
                threading.Thread(target=_pass, args=(*pair, bytes_per_s), daemon=True).start()


def _pass(source: socket.socket, sink: socket.socket, bytes_per_s: Callable[[], float]) -> None:
    with suppress(OSError):
        while data := source.recv(256):
            time.sleep(len(data) / bytes_per_s())
            sink.sendall(data)
    for one in (source, sink):
        with suppress(OSError), one:
            one.shutdown(socket.SHUT_RDWR)


def _program() -> str:
    found = shutil.which("mosquitto", path=f"{os.environ['PATH']}:/usr/sbin")
    if found is None:
        assert REQUIRED not in os.environ, "there is no mosquitto: apt-get install mosquitto"
        pytest.skip("there is no mosquitto: apt-get install mosquitto")
    return found
