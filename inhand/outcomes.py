"""``inhand outcomes``: the daemon of outcomes, or what it has kept."""

from collections.abc import Sequence

from inhand_outcomes.service import run
from inhand_outcomes.settings import OutcomesSettings, check
from inhand_runtime.entry import daemon_main

from inhand.outcomes_words import COMMANDS


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the daemon until SIGTERM or Ctrl-C, or answer from what it has kept.

    Returns the exit code. Answering raises SettingsError, and InhandError for a database that
    cannot be read.
    """
    if arguments and arguments[0] in COMMANDS:
        from inhand.outcomes_kept import ask

        return ask(arguments, OutcomesSettings)
    epilog = "; ".join(f"`inhand outcomes {verb}`: {text}" for verb, text in COMMANDS.items())
    return daemon_main(
        "outcomes", OutcomesSettings, run, arguments, check=check, epilog=f"What it keeps: {epilog}"
    )
