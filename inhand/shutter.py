"""``inhand shutter``: close or open the shutter of a rig's cameras.

While it is closed no picture and no skeleton leaves the cameras, also after a restart.
"""

import argparse

from inhand_capture.shutter import ShutterFile
from inhand_runtime.errors import InhandError
from inhand_runtime.exit_codes import DONE, FAILED
from inhand_runtime.settings import load_rig_file
from inhand_runtime.wording import printable
from inhand_schemas.keys import Site
from inhand_schemas.procedures import SHUTTER, ShutterReply, ShutterRequest

from inhand.asking import SECONDS, ask_instances
from inhand.looking import UNREACHED, add_looking_arguments, expected_instances


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("move", choices=("close", "open"), help="what to do with the shutter")
    parser.add_argument("--camera", help="of this camera only (default: of all)")
    add_looking_arguments(parser, SECONDS, "to wait for cameras to answer")


def run(arguments: argparse.Namespace) -> int:
    """Ask all cameras, or one; exit code 1 unless each one that is meant has done it for good."""
    rig_file = load_rig_file(arguments.config)
    closed: bool = arguments.move == "close"
    expected = expected_instances("capture", rig_file.capture, arguments.camera)
    request = ShutterRequest(closed=closed, camera=arguments.camera)
    site, replies = ask_instances(SHUTTER, request, expected, arguments.config, arguments.seconds)
    problems = _report(replies)
    for camera in expected:
        if camera not in replies:
            problems.append(_unreached(site, camera, closed=closed))
    for line in problems:
        print(f"WRONG: {line}")
    return FAILED if problems else DONE


def _report(replies: dict[str, ShutterReply]) -> list[str]:
    """Print how each shutter is, and return what is wrong."""
    for camera, reply in sorted(replies.items()):
        print(f"{camera}: {'closed' if reply.closed else 'open'}")
    return [
        f"{camera}: {printable(reply.problem)}"
        for camera, reply in sorted(replies.items())
        if reply.problem
    ]


def _unreached(site: Site, camera: str, *, closed: bool) -> str:
    """Leave word for a camera of this host that does not answer; return the line about it."""
    word = "closed" if closed else "open"
    line = f"{camera} does not answer: {UNREACHED}. "
    try:
        ShutterFile(site, camera).write(closed=closed)
    except OSError as error:
        raise InhandError(line + f"Nor can it be noted for its start: {error}") from None
    return line + f"Where it runs on this host and as this user, it will start with it {word}"
