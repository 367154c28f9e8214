"""Words to recorders that run: ``inhand recorder pause`` and others."""

import argparse
import uuid
from collections.abc import Sequence
from pathlib import Path

import msgspec
from inhand_runtime.exit_codes import DONE, FAILED
from inhand_runtime.roll import short_key
from inhand_runtime.settings import load_rig_file
from inhand_runtime.wording import counted, sized
from inhand_runtime.writable import require_writable_file
from inhand_schemas.procedures import RecorderReply, RecorderRequest

from inhand.looking import (
    UNREACHED,
    add_looking_arguments,
    expected_instances,
    nothing_heard,
    open_look,
)
from inhand.recorder import COMMANDS, HELP
from inhand.results import write_json

SECONDS = 3.0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="inhand recorder", description="Ask running recorders.")
    verbs = parser.add_subparsers(dest="verb", required=True)
    for verb, text in HELP.items():
        one = verbs.add_parser(verb, help=text, description=f"{text[0].upper()}{text[1:]}.")
        one.add_argument("--name", help="of this recorder only (default: of all)")
        add_looking_arguments(one, SECONDS, "to wait for recorders to answer")
        one.add_argument("--json", type=Path, metavar="FILE", help="write the replies there")
    return parser


def ask(given: Sequence[str]) -> int:
    """Ask all recorders, or one; exit code 1 unless each one that is meant has done it.

    Raises SettingsError, and InhandError where nobody answers.
    """
    arguments = _parser().parse_args(given)
    if arguments.json is not None:
        require_writable_file(arguments.json)
    expected = expected_instances(
        "recorder", load_rig_file(arguments.config).recorder, arguments.name
    )
    request = RecorderRequest(id=uuid.uuid4().hex, recorder=arguments.name)

    def complete(replies: list[RecorderReply]) -> bool:
        return bool(expected) and {reply.recorder for reply in replies}.issuperset(expected)

    with open_look(arguments.config) as look:
        answers = look.ask(COMMANDS[arguments.verb], request, complete, arguments.seconds)
        replies = {reply.recorder: reply for reply in answers}
        if not replies and not expected:
            raise nothing_heard(look.site, arguments.seconds)
    for name, reply in sorted(replies.items()):
        print(f"{name}: {reply_text(reply)}")
        for key, kinds in reply.losses.items():
            print(
                f"{name}, {short_key(key)}: {kinds.transport} never came, {kinds.queue} came too "
                f"fast, {kinds.disk} could not be written"
            )
    problems = [
        *(f"{name}: {reply.problem}" for name, reply in sorted(replies.items()) if reply.problem),
        *(f"{name} does not answer: {UNREACHED}" for name in expected if name not in replies),
    ]
    for line in problems:
        print(f"WRONG: {line}")
    if arguments.json is not None:
        rows = [msgspec.to_builtins(reply) for _, reply in sorted(replies.items())]
        write_json(arguments.json, {"recorders": rows, "problems": problems})
    return FAILED if problems else DONE


def reply_text(reply: RecorderReply) -> str:
    """Return what a recorder does, in a line."""
    state = reply.recording
    if state.paused:
        text = "paused"
    elif state.file is None:
        text = "records from the next message on"
    else:
        text = f"records into {state.file}, {sized(state.file_bytes)} so far"
    if state.ring_bytes:
        text += f"; holds {state.ring_seconds:.1f} s, {sized(state.ring_bytes)}"
    if state.folder_bytes:
        text += f"; all recordings take {sized(state.folder_bytes)}"
    if state.clip is not None:
        text += f"; makes the clip {state.clip}"
    if state.unmanaged:
        text += (
            f"; no quota deletes {counted(state.unmanaged, 'recording')}, "
            f"{sized(state.unmanaged_bytes)}, which no recorder of this release or a later one has "
            "written"
        )
    if state.clips_bytes:
        text += f"; clips take {sized(state.clips_bytes)}"
    if state.colour:
        kept = {fate: count for fate, count in state.colour.items() if fate != "coded"}
        text += f"; colour as H.264 of {counted(state.colour.get('coded', 0), 'frame')}"
        text += "".join(f", as it came of {count:,} ({fate})" for fate, count in kept.items())
    return text if reply.finished is None else f"{text}; {reply.finished} is whole"
