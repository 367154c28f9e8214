"""What a real Home Assistant makes of outcomes: ``home_assistant_agrees.py PYTHON [--single]``.

PYTHON is the interpreter of an environment of its own with Home Assistant in it, as
``pip install homeassistant==2024.3.3 paho-mqtt==1.6.1 'josepy<2'`` (which needs ``--single``) or
``pip install homeassistant==2025.10.4 paho-mqtt==2.1.0`` under Python 3.13. A daemon measures
somebody who carries a cup; mosquitto, Home Assistant and the daemon are each ended and started
again.
"""

import argparse
import json
import re
import signal
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.parse
import urllib.request
from contextlib import suppress
from pathlib import Path
from typing import Any

from carried_cup import write_model
from mosquitto import PASSWORD, USER, Broker, mosquitto
from running_rig import Process, RunningRig, free_port

PATIENCE_S = 300.0
CLIENT = "http://127.0.0.1/"
CONFIGURATION = """
homeassistant:
  name: Test
  time_zone: UTC
http:
  server_host: 127.0.0.1
  server_port: {port}
api:
config:
onboarding:
logger:
  default: warning
{more}
"""
GOALS = """
[[outcomes.home.goals]]
name = "tidy"
kind = "put_down"
at_least = 2

[[outcomes.home.goals]]
name = "untidy"
kind = "put_down"
at_most = 0
"""
INTERACTION = "sweepFloor"
"""What the cup is used for, so that there is a total of each unit, and a map of the floor."""
PAGE = Path(__file__).parents[2] / "docs/home_assistant.md"
PAGES = """
frontend:
history:
conversation:
lovelace:
  mode: yaml
automation: !include automations.yaml
notify:
"""
CARRYING = Path(__file__).parent / "carrying_publisher.py"


class HomeAssistant:
    """Home Assistant in a folder, onboarded, with the MQTT integration."""

    def __init__(self, python: Path, folder: Path, more: str) -> None:
        self.port = free_port()
        self._python, self._folder = python, folder
        folder.mkdir()
        (folder / "configuration.yaml").write_text(CONFIGURATION.format(port=self.port, more=more))
        self._token = ""
        self._process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        with (self._folder / "output").open("ab") as output:
            command = [str(self._python), "-m", "homeassistant", "-c", str(self._folder)]
            self._process = subprocess.Popen(command, stdout=output, stderr=output)
        wait_for("Home Assistant to answer", self._answers)

    def stop(self) -> None:
        if self._process is not None:
            self._process.send_signal(signal.SIGTERM)
            self._process.wait(60.0)
            self._process = None

    def onboard(self, broker: Broker) -> None:
        """Make the owner, and connect it with the broker."""
        owner = {"name": "Owner", "username": "owner", "password": "owner", "language": "en"}
        made = self._post("/api/onboarding/users", {"client_id": CLIENT, **owner})
        grant = {"grant_type": "authorization_code", "code": made["auth_code"], "client_id": CLIENT}
        self._token = self._post("/auth/token", grant, form=True)["access_token"]
        flow = self.post("/api/config/config_entries/flow", {"handler": "mqtt"})
        if flow["type"] == "menu":
            flow = self._step(flow, {"next_step_id": "broker"})
        login = {"username": USER, "password": PASSWORD}
        done = self._step(flow, {"broker": "127.0.0.1", "port": broker.port, **login})
        assert done["type"] == "create_entry", done

    def post(self, path: str, body: dict[str, Any]) -> Any:
        return self._post(path, body)

    def states(self) -> dict[str, dict[str, Any]]:
        """All states by entity."""
        try:
            return {one["entity_id"]: one for one in self._ask("/api/states")}
        except OSError:
            return {}

    def image(self, entity: str) -> bytes:
        """The picture of an image entity."""
        path = self.states()[entity]["attributes"]["entity_picture"]
        with urllib.request.urlopen(f"http://127.0.0.1:{self.port}{path}", timeout=20.0) as answer:
            return bytes(answer.read())

    @property
    def token(self) -> str:
        return self._token

    @property
    def log(self) -> str:
        """What it complained of."""
        path = self._folder / "home-assistant.log"
        return path.read_text() if path.exists() else (self._folder / "output").read_text()

    def _step(self, flow: dict[str, Any], values: dict[str, Any]) -> Any:
        return self._post(f"/api/config/config_entries/flow/{flow['flow_id']}", values)

    def _answers(self) -> bool:
        assert self._process is not None
        assert self._process.poll() is None, (self._folder / "output").read_text()[-3000:]
        try:
            self._ask("/api/states" if self._token else "/api/onboarding")
        except urllib.error.HTTPError as error:
            return error.code == 401
        except OSError:
            return False
        return True

    def _post(self, path: str, body: dict[str, Any], *, form: bool = False) -> Any:
        data = urllib.parse.urlencode(body) if form else json.dumps(body)
        return self._ask(path, data.encode(), form=form)

    def _ask(self, path: str, data: bytes | None = None, *, form: bool = False) -> Any:
        kind = "application/x-www-form-urlencoded" if form else "application/json"
        headers = {"Content-Type": kind}
        if self._token:
            headers["Authorization"] = f"Bearer {self._token}"
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}", data, headers)
        with urllib.request.urlopen(request, timeout=60.0) as answer:
            return json.loads(answer.read())


def wait_for(what: str, condition: Any) -> Any:
    end = time.monotonic() + PATIENCE_S
    while not (value := condition()):
        assert time.monotonic() < end, f"never came: {what}"
        time.sleep(0.2)
    print(f"{time.monotonic() - BEGAN:6.1f} s  {what}", flush=True)
    return value


BEGAN = time.monotonic()


class Scene:
    """A rig with a daemon of outcomes, a broker and Home Assistant."""

    def __init__(
        self,
        rig: RunningRig,
        broker: Broker,
        home: HomeAssistant,
        *,
        single: bool,
        automations: bool,
    ) -> None:
        self.rig, self.broker, self.home, self._single = rig, broker, home, single
        self.automations = automations

    def start_daemon(self, *names: str) -> Process:
        """Start outcomes, which measures these objects."""
        folder = self.rig.folder
        models = [str(write_model(folder / name, INTERACTION, name)) for name in names]
        table = self.broker.settings(single_components=self._single)
        self.rig.configure(
            f'[outcomes.home]\nmodels = {json.dumps(models)}\ntime_zone = "UTC"\n{GOALS}{table}'
        )
        daemon = self.rig.inhand("outcomes", "--config", self.rig.config)
        daemon.said("is up")
        return daemon

    def carry(self, *, at_ns: int) -> None:
        """Let somebody carry the cup."""
        publisher = self.rig.python(
            CARRYING, "--meeting", self.rig.meeting, "--start-ns", str(at_ns)
        )
        assert publisher.wait() == 0, publisher.stderr

    def state(self, entity: str) -> str | None:
        one = self.home.states().get(entity)
        return None if one is None else str(one["state"])

    def triggered(self, automation: str) -> bool:
        """Whether an automation has run."""
        states = self.home.states()
        return bool(states[f"automation.{automation}"]["attributes"].get("last_triggered"))

    def shows(self, entity: str, value: str) -> None:
        """Wait until an entity has a state."""
        wait_for(f"{entity} = {value}", lambda: self.state(entity) == value)


def yaml_of_the_page() -> list[str]:
    """What people copy from the documentation: the dashboard and automations, for the cup."""
    parts = re.findall(r"```yaml\n(.*?)```", PAGE.read_text(), re.DOTALL)
    for name, here in (("drink", "untidy"), ("glasses", "cup"), ("mug_sip", "cup_put_down")):
        parts = [part.replace(f"goal_{name}", f"goal_{here}").replace(name, here) for part in parts]
    parts = [part.replace("notify.notify", "notify.persistent_notification") for part in parts]
    return [part.replace("mug", "cup") for part in parts]


def judge_entities(states: dict[str, dict[str, Any]]) -> None:
    """Compare units and classes with what each is."""
    wanted = {
        "sensor.cup_put_down_times": {"state_class": "total"},
        "sensor.cup_last_place": {"after": "put_down"},
        "binary_sensor.cup_in_use": {},
        "event.cup_event": {"event_type": "put_down"},
        "button.forget_today": {},
        "switch.pause_measuring": {},
        "sensor.goal_tidy_progress": {"state_class": "total", "wanted": 2},
        "binary_sensor.goal_tidy_reached": {},
        "event.goal_tidy_event": {},
        **SWEEPING,
    }
    missing = wanted.keys() - states.keys()
    assert not missing, (missing, sorted(states))
    for entity, attributes in wanted.items():
        shown = states[entity]["attributes"]
        for name, value in attributes.items():
            assert shown.get(name) == value, (entity, name, shown)
    print(f"{len(states)} entities; units and classes of {len(wanted)} agree", flush=True)


SWEEPING: dict[str, dict[str, Any]] = {
    "sensor.cup_sweeping_area": {"unit_of_measurement": "m²", "state_class": "total"},
    "sensor.cup_sweeping_duration": {
        "device_class": "duration",
        "unit_of_measurement": "s",
        "state_class": "total",
    },
}


def play(scene: Scene) -> None:
    """Go through a day of a home, and its mishaps."""
    home, broker = scene.home, scene.broker
    daemon = scene.start_daemon("cup", "bowl")
    wait_for("the entities", lambda: "sensor.cup_put_down_times" in home.states())
    scene.shows("sensor.cup_put_down_times", "0")
    assert "sensor.bowl_last_place" in home.states()
    now_ns = time.time_ns() - 60 * 10**9
    scene.carry(at_ns=now_ns)
    scene.shows("sensor.cup_put_down_times", "1")
    scene.shows("binary_sensor.cup_in_use", "off")
    scene.shows("binary_sensor.goal_tidy_reached", "off")
    wait_for("the event", lambda: scene.state("event.cup_event") not in (None, "unknown"))
    judge_entities(home.states())
    if scene.automations:
        wait_for("the automation", lambda: scene.triggered("say_when_too_little_was_drunk"))
        asked = home.post("/api/conversation/process", {"text": "where are my cup"})
        print(asked["response"]["speech"]["plain"]["speech"], flush=True)

    home.post("/api/services/switch/turn_on", {"entity_id": "switch.pause_measuring"})
    scene.shows("switch.pause_measuring", "on")
    scene.carry(at_ns=now_ns + 12 * 10**9)
    daemon.stop()
    scene.shows("sensor.cup_put_down_times", "unavailable")
    scene.start_daemon("cup")
    scene.shows("switch.pause_measuring", "on")
    scene.shows("sensor.cup_put_down_times", "1")
    assert scene.rig.health("home")["paused"] is True
    wait_for("the bowl's end", lambda: not [one for one in home.states() if "bowl" in one])
    home.post("/api/services/switch/turn_off", {"entity_id": "switch.pause_measuring"})
    scene.shows("switch.pause_measuring", "off")

    broker.stop()
    scene.shows("sensor.cup_put_down_times", "unavailable")
    scene.carry(at_ns=now_ns + 24 * 10**9)
    broker.start()
    scene.shows("sensor.cup_put_down_times", "2")
    scene.shows("binary_sensor.goal_tidy_reached", "on")

    home.stop()
    scene.carry(at_ns=now_ns + 36 * 10**9)
    home.start()
    scene.shows("sensor.cup_put_down_times", "3")

    home.post("/api/services/button/press", {"entity_id": "button.forget_today"})
    scene.shows("sensor.cup_put_down_times", "0")
    scene.shows("binary_sensor.goal_tidy_reached", "off")
    scene.carry(at_ns=time.time_ns())
    scene.shows("sensor.cup_put_down_times", "1")


def main() -> int:
    """Run the scene; the exit code is 0 where Home Assistant agrees."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("python", type=Path)
    parser.add_argument("--single", action="store_true", help="for Home Assistant before 2024.11")
    parser.add_argument("--frontend", action="store_true", help="with its pages")
    parser.add_argument("--stay", action="store_true", help="wait for Enter before the end")
    chosen = parser.parse_args()
    more = PAGES if chosen.frontend else ""
    with tempfile.TemporaryDirectory() as name, mosquitto(Path(name) / "broker") as broker:
        folder = Path(name)
        home = HomeAssistant(chosen.python, folder / "home", more)
        if chosen.frontend:
            dashboard, *automations = yaml_of_the_page()
            (folder / "home" / "ui-lovelace.yaml").write_text(dashboard)
            (folder / "home" / "automations.yaml").write_text("".join(automations))
        rig = RunningRig(folder)
        try:
            home.start()
            home.onboard(broker)
            pages = chosen.frontend
            play(Scene(rig, broker, home, single=chosen.single, automations=pages))
            complaints = [line for line in home.log.splitlines() if "mqtt" in line.lower()]
            print("\n".join(complaints))
            if chosen.stay:
                print(f"http://127.0.0.1:{home.port} {home.token} {folder}", flush=True)
                sys.stdin.readline()
        except BaseException:
            print(home.log)
            raise
        finally:
            rig.close()
            with suppress(subprocess.TimeoutExpired):
                home.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
