"""The files that make Inhand a part of a Linux system, and where each goes."""

import sys
from pathlib import Path

import inhand

PLACES = {
    "systemd": "etc/systemd/system",
    "sysusers.d": "etc/sysusers.d",
    "tmpfiles.d": "etc/tmpfiles.d",
    "udev": "etc/udev/rules.d",
    "prometheus": "usr/local/share/inhand/prometheus",
    "settings": "usr/local/share/inhand/settings",
}
"""By folder of ``deploy``: where its files go, below the root of a system."""
PROGRAM = "/usr/bin/inhand"
"""The command as the units have it, in whose place comes the one that is installed."""


def deploy_folder() -> Path:
    """Return the folder ``deploy``: in the package, or beside it where this is a checkout."""
    package = Path(inhand.__file__).parent
    inside = package / "deploy"
    return inside if inside.is_dir() else package.parent / "deploy"


def program() -> str:
    """Return the command that runs this installation, as a unit writes it."""
    script = Path(sys.executable).with_name("inhand")
    return str(script) if script.exists() else f"{sys.executable} -m inhand"


def deployed_files(command: str) -> dict[str, str]:
    """Return the text of each file by its place below the root; services run the ``command``."""
    folder = deploy_folder()
    return {
        f"{place}/{path.relative_to(folder / part).as_posix()}": path.read_text(
            encoding="utf-8"
        ).replace(PROGRAM, command)
        for part, place in PLACES.items()
        for path in sorted((folder / part).rglob("*"))
        if path.is_file()
    }
