"""``inhand recorder``: one recorder daemon, or a word to those that run."""

from collections.abc import Sequence

from inhand_recorder.service import run
from inhand_recorder.settings import RecorderSettings, check
from inhand_runtime.entry import daemon_main
from inhand_schemas.procedures import RECORDER_PROCEDURES

COMMANDS = {procedure.verb: procedure for procedure in RECORDER_PROCEDURES}
HELP = {
    "pause": "make the file under way whole, and record nothing until resume",
    "resume": "record again",
    "split": "make the file under way whole, and begin another",
    "snapshot": "make a clip of the last seconds, and of those after",
    "status": "say what is recorded",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the daemon until SIGTERM or Ctrl-C, or ask those that run; returns the exit code.

    Asking raises SettingsError, and InhandError where nobody answers.
    """
    if arguments and arguments[0] in COMMANDS:
        from inhand.recorder_asking import ask

        return ask(arguments)
    epilog = "; ".join(f"`inhand recorder {verb}`: {text}" for verb, text in HELP.items())
    return daemon_main(
        "recorder", RecorderSettings, run, arguments, check=check, epilog=f"One that runs: {epilog}"
    )
