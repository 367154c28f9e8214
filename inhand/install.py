"""``inhand install``: put systemd units, rules for cameras and sample settings into this system.

Needs root, unless ``--root`` names a folder of one's own.
"""

import argparse
import os
import sys
from pathlib import Path

from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.exit_codes import DONE
from inhand_runtime.wording import counted

from inhand.deployment import deployed_files, program
from inhand.installation import Installation

SYSTEM = Path("/")
UNSEEN = ("home", "root", "tmp")
"""Folders of the system's root into which units may not look, nor run a program there."""
AFTERWARDS = """\
Then, once:   systemd-sysusers && systemd-tmpfiles --create
              udevadm control --reload-rules && udevadm trigger
              systemctl daemon-reload
One host:     cp {samples}/one_host.toml /etc/inhand/rig.toml
              systemctl enable --now inhand-up
With a hub:   a file for each member, /etc/inhand/front.toml, and
              systemctl enable --now inhand-capture@front"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument(
        "--root", type=Path, default=SYSTEM, metavar="FOLDER", help="a system's root (default: /)"
    )
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--print", action="store_true", help="print the files, and change nothing")
    what.add_argument("--uninstall", action="store_true", help="remove what was put there")


def run(arguments: argparse.Namespace) -> int:
    """Do what was asked; raises SettingsError or InhandError, and changes nothing then."""
    root: Path = arguments.root.absolute()
    if arguments.print:
        for place, text in deployed_files(program()).items():
            print(f"# {root / place}\n{text}")
        return DONE
    try:
        return _uninstall(root) if arguments.uninstall else _install(root)
    except OSError as error:
        raise InhandError(
            f"cannot change {error.filename}: {error.strerror}; run it as root, or name a folder "
            "by --root"
        ) from None


def _install(root: Path) -> int:
    command = program()
    if root == SYSTEM and Path(command).parts[1] in UNSEEN:
        raise SettingsError(
            f"units may not look into homes, where this Inhand is ({command}): install it "
            "elsewhere, as by `python3 -m venv /opt/inhand`"
        )
    files = deployed_files(command)
    changed = Installation(root).install(files)
    if missing := _missing_program(root, command):
        print(
            f"its units run {missing}, which is not in {root}: put Inhand there, or run its own: "
            f"chroot {root} /opt/inhand/bin/inhand install",
            file=sys.stderr,
        )
    print(f"{counted(len(files), 'file')} in place, {len(changed)} of them changed")
    print(AFTERWARDS.format(samples="/usr/local/share/inhand/settings"))
    return DONE


def _missing_program(root: Path, command: str) -> str | None:
    """Return the program of a command, unless it is there below the root."""
    program_path = command.split()[0]
    return None if os.path.lexists(root / program_path.lstrip("/")) else program_path


def _uninstall(root: Path) -> int:
    removed, kept = Installation(root).uninstall()
    print(f"removed {counted(len(removed), 'file')}")
    for place in kept:
        print(f"left {root / place}, which was changed since", file=sys.stderr)
    if root == SYSTEM:
        print("Units that run go on until they are stopped: systemctl disable --now 'inhand-*'")
    return DONE
