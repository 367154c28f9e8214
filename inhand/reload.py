"""``inhand reload``: have a running `inhand up` take over its settings file, which has changed.

Only processes whose settings changed start anew. A file that is wrong changes nothing.
"""

import argparse
import sys
from pathlib import Path

from inhand_runtime.exit_codes import DONE, WRONG_USAGE

from inhand.up_socket import ask_to_reload


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument(
        "--config",
        type=Path,
        required=True,
        metavar="FILE",
        help="the settings (TOML) with which `inhand up` runs",
    )


def run(arguments: argparse.Namespace) -> int:
    """Ask, and print what changes; InhandError where no `inhand up` runs with that file."""
    answer = ask_to_reload(arguments.config)
    for line in answer.lines:
        print(
            line if answer.taken else f"inhand reload: {line}",
            file=sys.stdout if answer.taken else sys.stderr,
        )
    return DONE if answer.taken else WRONG_USAGE
