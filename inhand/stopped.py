"""Services of a rig that are stopped (Ctrl-Z, SIGSTOP) on this machine.

A process shows its liveliness token itself, and one that is stopped shows it to nobody who comes
later: to a look that begins then it is as if it did not run. What the system says of processes
tells the two apart.
"""

from collections.abc import Collection, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import psutil
from inhand_runtime.roll import Instance
from inhand_runtime.settings import SERVICES, ZenohSettings

_STATES = (psutil.STATUS_STOPPED, psutil.STATUS_TRACING_STOP)
_REPLAY = "replay"


@dataclass(frozen=True)
class Stopped:
    """A process that stands still; ``name`` is None where its command names no instance."""

    pid: int
    service: str
    name: str | None
    command: str


def stopped_services(zenoh: ZenohSettings) -> list[Stopped]:
    """Return the stopped services of this machine that use an address of these settings."""
    addresses = (zenoh.meeting, *zenoh.listen, *zenoh.connect)
    ports = {port for address in addresses if (port := _port(address)) is not None}
    stopped = []
    for process in psutil.process_iter():
        with suppress(psutil.Error):  # it ended meanwhile, or belongs to somebody else
            if process.status() not in _STATES:
                continue
            words = _words(process.cmdline())
            service = "capture" if words[:1] == [_REPLAY] else "".join(words[:1])
            if service in SERVICES and _uses(process, ports):
                command = " ".join(("inhand", *words))
                stopped.append(Stopped(process.pid, service, _name(words), command))
    return stopped


def stopped_lines(
    stopped: Iterable[Stopped], missing: Collection[Instance], silent: Collection[Instance]
) -> dict[str, Instance | None]:
    """Return a line for each that is stopped, with the instance that is then not missing, if any.

    One that is ``silent``, and lives by its token, is left out: it is known to hang without this. A
    command that names no instance is the one of its service that is missing or silent, where there
    is only one.
    """
    lines: dict[str, Instance | None] = {}
    for one in stopped:
        of_service = [instance for instance in (*missing, *silent) if instance[0] == one.service]
        instance = None if one.name is None else (one.service, one.name)
        if instance is None and len(of_service) == 1 and _REPLAY not in one.command.split():
            instance = of_service[0]
        if instance in silent:
            continue
        who = f"`{one.command}`" if instance is None else " ".join(instance)
        lines[
            f"{who} hangs, or is stopped: process {one.pid} of this machine stands still; "
            f"`kill -CONT {one.pid}` lets it go on"
        ] = instance
    return lines


def _words(command: Sequence[str]) -> list[str]:
    """The verb and its arguments, of a command that runs Inhand or one of its services."""
    for place, word in enumerate(command):
        if word == "-m" and command[place + 1 : place + 2] == ["inhand"]:
            return list(command[place + 2 :])
        if Path(word).name == "inhand":
            return list(command[place + 1 :])
        module = word.removeprefix("inhand_").removeprefix("inhand-")
        if word != module and module in SERVICES:
            return [module, *command[place + 1 :]]
    return []


def _name(words: Sequence[str]) -> str | None:
    for place, word in enumerate(words):
        if word == "--name" and place + 1 < len(words):
            return words[place + 1]
        if word.startswith("--name="):
            return word.removeprefix("--name=")
    return None


def _uses(process: psutil.Process, ports: Collection[int]) -> bool:
    return any(
        getattr(address, "port", None) in ports
        for connection in process.net_connections(kind="inet")
        for address in (connection.laddr, connection.raddr)
    )


def _port(address: str) -> int | None:
    """The port of an address such as ``tcp/127.0.0.1:7447``, which may have ``#`` and more."""
    number = address.partition("#")[0].partition("?")[0].rpartition(":")[2]
    return int(number) if number.isdigit() else None
