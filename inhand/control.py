"""``inhand control``: change settings of a camera while it runs, such as exposure_us=8000 iso=400.

They hold until the daemon ends; what shall stay is written into the settings file.
"""

import argparse

from inhand_runtime.errors import InhandError
from inhand_runtime.exit_codes import DONE
from inhand_runtime.wording import printable
from inhand_schemas.procedures import CONTROL, ControlReply, ControlRequest

from inhand.looking import UNREACHED, add_looking_arguments, camera_name, open_look

SECONDS = 3.0
AUTOMATIC = "auto"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("camera", type=camera_name, help="the camera's name")
    parser.add_argument(
        "settings",
        nargs="+",
        type=_setting,
        metavar="OPTION=VALUE",
        help=f"an option of its source, and a number or {AUTOMATIC}",
    )
    add_looking_arguments(parser, SECONDS, "to wait for an answer")


def run(arguments: argparse.Namespace) -> int:
    """Ask the camera; raises InhandError when it does not answer, or cannot do it."""
    request = ControlRequest(camera=arguments.camera, options=dict(arguments.settings))

    def complete(replies: list[ControlReply]) -> bool:
        return bool(replies)

    with open_look(arguments.config) as look:
        replies = look.ask(CONTROL, request, complete, arguments.seconds)
    if not replies:
        raise InhandError(f"{arguments.camera} does not answer: {UNREACHED}")
    if (problem := replies[-1].problem) is not None:
        raise InhandError(f"{arguments.camera}: {printable(problem)}")
    print(f"{arguments.camera}: done, until it ends")
    return DONE


def _setting(text: str) -> tuple[str, int | float | None]:
    name, equals, value = text.partition("=")
    if not name or not equals:
        raise argparse.ArgumentTypeError(f"write OPTION=VALUE, not {text!r}")
    if value == AUTOMATIC:
        return name, None
    for kind in (int, float):
        try:
            return name, kind(value)
        except ValueError:
            continue
    raise argparse.ArgumentTypeError(f"{value!r} is neither a number nor {AUTOMATIC}")
