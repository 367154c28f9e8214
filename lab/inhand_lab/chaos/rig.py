"""A rig of real processes that faults are inflicted on, of one host or of two with a hub."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import psutil
from inhand_runtime.errors import InhandError
from inhand_runtime.session import Session, open_session
from inhand_runtime.settings import ZenohSettings, load_rig_file
from inhand_runtime.supervisor_watch import supervised
from inhand_schemas.keys import Site
from inhand_schemas.topics import POSE

from inhand_lab.chaos.host import Host, new_host
from inhand_lab.chaos.link import Link
from inhand_lab.chaos.parameters import DEFAULT_CHAOS
from inhand_lab.chaos.watch import Watch
from inhand_lab.demonstration.preparation import free_port, rig_tables, write_rig_file

SERVICES = ("recorder", "tracker", "capture")
MEMBERS = (("recorder", "disk"), ("tracker", "follower"), ("camera", "camera"))
"""The role and the name of each, in a site with a hub."""
REALM, RIG, OBJECT = "chaos", "demo", "mug"
INHAND = (sys.executable, "-m", "inhand")


class Hub:
    """A hub's process, which can end and start again."""

    def __init__(self, config: Path) -> None:
        self._command = [*INHAND, "hub", "--config", str(config)]
        self._process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Start it."""
        self._process = subprocess.Popen(
            self._command,
            env={**os.environ, **supervised()},
            stdin=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    @property
    def pid(self) -> int | None:
        """Its process, if it has started."""
        return None if self._process is None else self._process.pid

    def kill(self) -> None:
        """End it at once."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()


@dataclass(frozen=True)
class ChaosRig:
    """A rig under ``inhand up``, a session in it, and what has come so far.

    ``config`` is the settings file of whoever looks at all of it, ``configs`` are those of the
    services. With a ``hub`` the camera is on another host, behind a ``link``.
    """

    folder: Path
    config: Path
    configs: Mapping[str, Path]
    supervisors: tuple[psutil.Popen, ...]
    session: Session
    site: Site
    watch: Watch
    host: Host
    hub: Hub | None
    link: Link | None
    messages: int = DEFAULT_CHAOS.flood_messages
    """Number of messages of a flood."""

    @property
    def recordings(self) -> Path:
        """The folder that its recorder writes to."""
        return self.folder / "recordings"

    def processes(self) -> dict[str, psutil.Process]:
        """The processes that run now, by service."""
        found: dict[str, psutil.Process] = {}
        for child in (child for one in self.supervisors for child in one.children()):
            try:
                arguments = child.cmdline()
            except psutil.NoSuchProcess:
                continue
            found |= {service: child for service in SERVICES if service in arguments}
        return found

    def all_processes(self) -> dict[str, psutil.Process]:
        """The processes that run now: those of the services, what supervises each, and the hub."""
        services: dict[Path, str] = {}
        for service, path in self.configs.items():
            services.setdefault(path, service)
        ups = zip(services.values(), self.supervisors, strict=True)
        found = {**self.processes(), **{f"up of {service}": up for service, up in ups}}
        if self.hub is not None and self.hub.pid is not None:
            with suppress(psutil.NoSuchProcess):
                found["hub"] = psutil.Process(self.hub.pid)
        return found

    def resident_mb(self) -> dict[int, float]:
        """How much memory each process takes now, in MB."""
        return {one.pid: one.memory_info().rss / 1e6 for one in self.processes().values()}

    def process(self, service: str) -> psutil.Process:
        """The process of a service; raises InhandError where none runs."""
        found = self.processes().get(service)
        if found is None:
            raise InhandError(f"no {service} runs: the fault before has ended it for good")
        return found


@contextmanager
def one_host(folder: Path, model: Path) -> Iterator[ChaosRig]:
    """Run a simulated camera, a tracker and a recorder as peers until the block ends.

    Raises InhandError where no pose comes.
    """
    host = new_host(folder / "host")
    config = write_rig_file(folder, DEFAULT_CHAOS.interaction, model)
    text = _pluggable(config.read_text(encoding="utf-8"), host)
    config.write_text(text, encoding="utf-8")
    with _running(folder, config, dict.fromkeys(SERVICES, config), host) as rig:
        yield rig


def _pluggable(table: str, host: Host) -> str:
    """Return settings whose simulated camera is one that can be unplugged from a host."""
    options = "[capture.camera.options]"
    plugged = table.replace('"simulator"', '"pluggable"')
    return plugged.replace(options, f"{options}\nplug = {json.dumps(str(host.plug))}")


@contextmanager
def two_hosts(folder: Path, model: Path, *, recorder: str = "") -> Iterator[ChaosRig]:
    """Run the same as members of a site with a hub, the camera behind a link, until the block ends.

    ``recorder`` are lines for its table. Raises InhandError where no pose comes, or the site cannot
    be made.
    """
    host = new_host(folder / "host")
    tables = rig_tables(folder, DEFAULT_CHAOS.interaction, model)
    tables["capture"] = _pluggable(tables["capture"], host)
    tables["recorder"] += f"\n{recorder}"
    port = free_port()
    with ExitStack() as stack:
        link = stack.enter_context(Link(port).open())
        _administer(folder, "init", "site", "--realm", REALM, "--rigs", RIG)
        configs = {
            service: _write_member(
                folder, role, name, link.port if service == "capture" else port, tables[service]
            )
            for service, (role, name) in zip(SERVICES, MEMBERS, strict=True)
        }
        look = _write_member(folder, "viewer", "observer", port, "\n".join(tables.values()))
        hub_config = folder / "hub.toml"
        hub_config.write_text(
            f'realm = "{REALM}"\nrig = "{RIG}"\n[hub.hub]\nfolder = "site/hub"\n'
            f'listen = ["tls/127.0.0.1:{port}"]\n',
            encoding="utf-8",
        )
        hub = Hub(hub_config)
        stack.callback(hub.kill)
        hub.start()
        yield stack.enter_context(_running(folder, look, configs, host, hub, link))


@contextmanager
def _running(
    folder: Path,
    config: Path,
    configs: Mapping[str, Path],
    host: Host,
    hub: Hub | None = None,
    link: Link | None = None,
) -> Iterator[ChaosRig]:
    rig_file = load_rig_file(config)
    site, watch = Site(rig_file.realm, rig_file.rig), Watch(host.clock)
    with ExitStack() as stack:
        session = stack.enter_context(_opened(rig_file.zenoh))
        stack.enter_context(watch.listening(session, site))
        # The camera last, so that nobody misses its first frames.
        supervisors = tuple(
            stack.enter_context(_supervised(path, host)) for path in dict.fromkeys(configs.values())
        )
        rig = ChaosRig(folder, config, configs, supervisors, session, site, watch, host, hub, link)
        _wait_for_poses(rig)
        yield rig


def _opened(settings: ZenohSettings) -> AbstractContextManager[Session]:
    """Open a session; a hub that has just been started is not there at once."""
    end = time.monotonic() + DEFAULT_CHAOS.up_within_s
    while True:
        try:
            with open_session(settings):
                pass
        except InhandError:
            if time.monotonic() > end:
                raise
            time.sleep(0.5)
        else:
            return open_session(settings)


@contextmanager
def _supervised(config: Path, host: Host) -> Iterator[psutil.Popen]:
    """Run ``inhand up`` until the block ends; what it says stands beside its settings."""
    with config.with_suffix(".log").open("wb") as log:
        up = psutil.Popen(
            [*INHAND, "up", "--config", str(config)],
            env={**host.environment, **supervised()},
            stdin=subprocess.DEVNULL,
            stderr=log,
        )
    try:
        yield up
    finally:
        up.send_signal(signal.SIGTERM)
        up.wait()


def _wait_for_poses(rig: ChaosRig) -> None:
    end = time.monotonic() + DEFAULT_CHAOS.up_within_s
    while len(rig.watch.of(POSE).came) == 0:
        if time.monotonic() > end or not all(one.is_running() for one in rig.supervisors):
            said = "\n".join(path.read_text() for path in rig.folder.glob("*.log"))
            raise InhandError(f"no pose came:\n{said}")
        time.sleep(0.1)


def _administer(folder: Path, *arguments: str) -> None:
    """Run ``inhand hub init`` or ``add``; raises InhandError with what it says."""
    command = [*INHAND, "hub", *arguments]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise InhandError(done.stderr.strip())


def _write_member(folder: Path, role: str, name: str, port: int, table: str) -> Path:
    """Let a member join, and write its settings."""
    objects = ("--objects", OBJECT) if role == "tracker" else ()
    _administer(folder, "add", role, name, *objects)
    given = f"site/members/{RIG}.{name}"
    path = folder / f"{name}.toml"
    path.write_text(
        f'realm = "{REALM}"\nrig = "{RIG}"\n[log]\nlevel = "warning"\n'
        f'[zenoh]\nmode = "client"\nconnect = ["tls/127.0.0.1:{port}"]\n'
        f'certificate = "{given}/certificate.pem"\nkey = "{given}/key.pem"\n'
        f'authority = "{given}/authority.pem"\n{table}\n',
        encoding="utf-8",
    )
    return path
