"""Starts the processes of a rig on a free port, and waits on what they say."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

ROOT = Path(__file__).parents[2]
PATIENCE_S = 60.0


def eventually(what: str, condition: Callable[[], Any]) -> Any:
    """The first true value of ``condition``; fails the test when it never comes."""
    end = time.monotonic() + PATIENCE_S
    while not (value := condition()):
        assert time.monotonic() < end, f"never came: {what}"
        time.sleep(0.02)
    return value


class Process:
    """One process with its output in files."""

    def __init__(self, folder: Path, number: int, command: list[str], env: dict[str, str]) -> None:
        self._paths = {name: folder / f"{number}.{name}" for name in ("stdout", "stderr")}
        outputs: dict[str, IO[bytes]] = {n: path.open("wb") for n, path in self._paths.items()}
        try:
            self.popen = subprocess.Popen(
                command, cwd=ROOT, env=os.environ | env, stdin=subprocess.DEVNULL, **outputs
            )
        finally:
            for output in outputs.values():
                output.close()
        self.pid = self.popen.pid

    @property
    def stdout(self) -> str:
        """What it printed so far."""
        return self._paths["stdout"].read_text()

    @property
    def stderr(self) -> str:
        """What it logged so far."""
        return self._paths["stderr"].read_text()

    def said(self, text: str) -> None:
        """Wait until it printed or logged ``text``."""

        def heard() -> bool:
            ended = self.popen.poll() is not None
            if text in self.stdout + self.stderr:
                return True
            assert not ended, f"ended before it said {text!r}:\n{self.stderr}"
            return False

        eventually(f"{text!r} from {self.popen.args}", heard)

    def wait(self) -> int:
        """Wait for its end; returns the exit code."""
        return self.popen.wait(PATIENCE_S)

    def stop(self, number: int = signal.SIGTERM) -> int:
        """Send a signal and wait; returns the exit code."""
        self.popen.send_signal(number)
        return self.wait()


class RunningRig:
    """Processes that meet on a port of their own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.config = folder / "rig.toml"
        self.meeting = f"tcp/127.0.0.1:{free_port()}"
        self._processes: list[Process] = []
        self.configure("")

    def configure(self, text: str) -> None:
        """Write the settings file: ``text`` and where to meet."""
        self.config.write_text(f'{text}\n[zenoh]\nmeeting = "{self.meeting}"\n')

    def inhand(self, *arguments: str | Path, **env: str) -> Process:
        """Start a verb; ``--config`` is for the caller to add."""
        return self._start([sys.executable, "-m", "inhand", *map(str, arguments)], env)

    def publisher(self, *arguments: str) -> Process:
        """Start ``publisher.py``, and wait until it is ready."""
        script = str(Path(__file__).parent / "publisher.py")
        started = self._start([sys.executable, script, "--meeting", self.meeting, *arguments], {})
        started.said("ready")
        return started

    def command(self, *arguments: str | Path) -> Process:
        """Start any program."""
        return self._start([str(one) for one in arguments], {})

    def python(self, *arguments: str | Path, **env: str) -> Process:
        """Start a Python program."""
        return self._start([sys.executable, *map(str, arguments)], env)

    def done(self, *arguments: str | Path) -> Process:
        """Run a verb to its end."""
        process = self.inhand(*arguments)
        process.wait()
        return process

    def health(self, instance: str) -> dict[str, Any]:
        """What ``inhand status`` tells of an instance that runs."""
        return self.healths()[instance]

    def counted(self, instance: str, key: str, count: str) -> int:
        """A count that an instance's health gives for a key; 0 before it tells of the key."""
        topics = self.healths().get(instance, {"topics": {}})["topics"]
        return int(topics.get(key, {count: 0})[count])

    def healths(self) -> dict[str, dict[str, Any]]:
        """What ``inhand status`` tells of all instances at one time."""
        path = self.folder / "status.json"
        meeting = self.folder / "meeting.toml"  # names nobody, so nobody is waited for
        meeting.write_text(f'[zenoh]\nmeeting = "{self.meeting}"\n')
        told = self.done("status", "--config", meeting, "--seconds", "30", "--json", path)
        assert told.popen.returncode in (0, 1), told.stderr
        instances = json.loads(path.read_text())["instances"]
        return {one["instance"]: one["health"] for one in instances}

    def close(self) -> None:
        """End what still runs."""
        for process in self._processes:
            process.popen.kill()
            process.wait()

    def _start(self, command: list[str], env: dict[str, str]) -> Process:
        process = Process(self.folder, len(self._processes), command, env)
        self._processes.append(process)
        return process


def free_port() -> int:
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        port: int = server.getsockname()[1]
        return port
