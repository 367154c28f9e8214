"""``inhand playback``: pause, resume, step through and seek in a replay that runs."""

import argparse

from inhand_runtime.errors import InhandError
from inhand_runtime.exit_codes import DONE
from inhand_schemas.playback import PLAYBACK, PlaybackReply, PlaybackRequest

from inhand.looking import UNREACHED, add_looking_arguments, camera_name, open_look

SECONDS = 3.0
WITH_VALUE = {
    "seek": "recorded seconds from the begin",
    "skip": "recorded seconds forward, or back (below 0)",
    "rate": "times the original pace, 0 = no pauses",
}
WITHOUT_VALUE = ("status", "pause", "resume", "step")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("camera", type=camera_name, metavar="CAMERA", help="which one is replayed")
    parser.add_argument("action", choices=(*WITHOUT_VALUE, *WITH_VALUE), help="what it shall do")
    values = "; ".join(f"{action}: {text}" for action, text in WITH_VALUE.items())
    parser.add_argument("value", nargs="?", type=float, metavar="VALUE", help=values)
    add_looking_arguments(parser, SECONDS, "to wait for an answer")


def run(arguments: argparse.Namespace) -> int:
    """Ask the camera; raises InhandError when it does not answer, or cannot do it."""
    request = PlaybackRequest(
        action=arguments.action, value=arguments.value, camera=arguments.camera
    )

    def complete(replies: list[PlaybackReply]) -> bool:
        return bool(replies)

    with open_look(arguments.config) as look:
        replies = look.ask(PLAYBACK, request, complete, arguments.seconds)
    if not replies:
        raise InhandError(f"{arguments.camera} does not answer: {UNREACHED}")
    reply = replies[-1]
    if reply.problem is not None:
        raise InhandError(f"{arguments.camera}: {reply.problem}")
    print(f"{arguments.camera}: {position_line(reply)}")
    return DONE


def position_line(reply: PlaybackReply) -> str:
    """Say where a replay is, in a few words."""
    position_s = 0.0 if reply.position_s is None else reply.position_s
    paused = ", paused" if reply.paused else ""
    return f"{position_s:.3f} of {reply.length_s:.3f} s at rate {reply.rate:g}{paused}"
