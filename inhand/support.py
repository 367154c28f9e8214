"""``inhand support``: write one file for a bug report, without secrets and without pictures.

Settings, versions, health and logs, as far as each is to be had; it prints what is in the file.
"""

import argparse
import io
import json
import os
import tarfile
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from inhand_runtime.errors import InhandError
from inhand_runtime.exit_codes import DONE
from inhand_runtime.private_file import PRIVATE_FILE, new_private_file
from inhand_runtime.settings import RigFile, load_rig_file
from inhand_runtime.settings_environment import with_environment
from inhand_runtime.settings_file import read_values

from inhand.host_facts import journal, system, versions
from inhand.shown_settings import Shown
from inhand.status import look_at_site


@dataclass(frozen=True)
class Part:
    """One file of the bundle: its name, its text, and what is said of it."""

    name: str
    text: str
    said: str


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("--config", type=Path, metavar="FILE", help="the rig's settings (TOML)")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="FILE",
        help="where to write it (default: inhand-support-TIME.tar.gz)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Write the file, also where settings are wrong and nothing runs; raises InhandError."""
    moment = time.strftime("%Y%m%dT%H%M%SZ", time.gmtime())
    output: Path = arguments.output or Path(f"inhand-support-{moment}.tar.gz")
    parts = _parts(arguments.config)
    _write(output, f"inhand-support-{moment}", parts)
    print(f"wrote {output}, which only you can read:")
    for part in parts:
        print(f"  {part.name:14} {len(part.text.encode()):>9,} bytes  {part.said}")
    print("No secrets, no keys and no pictures are in it. Read it before you send it.")
    return DONE


def _parts(config: Path | None) -> list[Part]:
    values, wrong = _settings(config)
    shown = Shown(values, Path() if config is None else config.parent)

    def part(name: str, value: Any, said: str) -> Part:
        return Part(name, json.dumps(_cleaned(value, shown), indent=1, default=str) + "\n", said)

    health, health_said = _health(config)
    lines, none = journal()
    lines = shown.cleaned(lines if none is None else f"{none}\n")
    said = f"{config}, without secrets" if config else "none were named: --config"
    settings = {"settings": shown.settings, "wrong": wrong, "environment": _variables()}
    return [
        part("settings.json", settings, shown.cleaned(wrong or said)),
        part("versions.json", versions(), "Inhand and its libraries"),
        part("system.json", system(), "kind of system, cores, memory"),
        part("health.json", health, shown.cleaned(health_said)),
        Part("logs.txt", lines, none or "the last lines of the journal"),
    ]


def _settings(config: Path | None) -> tuple[dict[str, Any], str | None]:
    """Return what the file and the environment say, and what is wrong with that."""
    values: dict[str, Any] = {}
    try:
        values = {} if config is None else read_values(config)
        values = with_environment(values, RigFile)
        load_rig_file(config)
    except InhandError as error:
        return values, str(error)
    return values, None


def _variables() -> list[str]:
    return sorted(name for name in os.environ if name.upper().startswith("INHAND_"))


def _health(config: Path | None) -> tuple[dict[str, Any], str]:
    """Return what ``inhand status --json`` would write, and what is said of it."""
    try:
        state = look_at_site(config)
    except InhandError as error:
        return {"instances": [], "problems": [str(error)]}, str(error)
    names = ", ".join(" ".join(instance) for instance in state.living)
    return state.for_machines(), f"health of {names}" if names else "nothing runs"


def _cleaned(value: Any, shown: Shown) -> Any:
    """Return a value with no secret in any of its texts."""
    if isinstance(value, Mapping):
        return {shown.cleaned(str(key)): _cleaned(one, shown) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_cleaned(one, shown) for one in value]
    return shown.cleaned(value) if isinstance(value, str) else value


def _write(path: Path, folder: str, parts: list[Part]) -> None:
    """Write the bundle whole or not at all, for its owner alone; raises InhandError."""
    try:
        with new_private_file(path) as file, tarfile.open(fileobj=file, mode="w:gz") as archive:
            for part in parts:
                data = part.text.encode()
                entry = tarfile.TarInfo(f"{folder}/{part.name}")
                entry.size, entry.mtime, entry.mode = len(data), int(time.time()), PRIVATE_FILE
                archive.addfile(entry, io.BytesIO(data))
    except OSError as error:
        raise InhandError(f"cannot write {path}: {error.strerror}; choose another file") from None
