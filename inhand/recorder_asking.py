"""Words to recorders that run: ``inhand recorder pause`` and others."""

import uuid
from collections.abc import Sequence

from inhand_runtime.roll import short_key
from inhand_runtime.settings import load_rig_file
from inhand_runtime.wording import counted, sized
from inhand_runtime.writable import require_writable_file
from inhand_schemas.procedures import RecorderReply, RecorderRequest

from inhand.asking import ask_instances, asking_parser, conclude
from inhand.looking import expected_instances
from inhand.recorder import COMMANDS, HELP


def ask(given: Sequence[str]) -> int:
    """Ask all recorders, or one; exit code 1 unless each one that is meant has done it.

    Raises SettingsError, and InhandError where nobody answers.
    """
    arguments = asking_parser("recorder", "recorders", HELP, named="recorder").parse_args(given)
    if arguments.json is not None:
        require_writable_file(arguments.json)
    tables = load_rig_file(arguments.config).recorder
    expected = expected_instances("recorder", tables, arguments.name)
    procedure = COMMANDS[arguments.verb]
    request = RecorderRequest(id=uuid.uuid4().hex, recorder=arguments.name)
    _, replies = ask_instances(procedure, request, expected, arguments.config, arguments.seconds)
    for name, reply in replies.items():
        print(f"{name}: {reply_text(reply)}")
        for key, kinds in reply.losses.items():
            print(
                f"{name}, {short_key(key)}: {kinds.transport} never came, {kinds.queue} came too "
                f"fast, {kinds.disk} could not be written"
            )
    return conclude(replies, expected, "recorders", arguments.json)


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
