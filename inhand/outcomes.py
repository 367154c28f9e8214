"""``inhand outcomes``: the daemon of outcomes, or what it has kept."""

from collections.abc import Sequence

from inhand_outcomes.service import run
from inhand_outcomes.settings import OutcomesSettings, check
from inhand_runtime.entry import daemon_main

from inhand.outcomes_words import ASKED, COMMANDS


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the daemon until SIGTERM or Ctrl-C, answer from what it has kept, or ask those that run.

    Returns the exit code. Answering raises SettingsError, and InhandError for a database that
    cannot be read; asking raises it where nobody answers.
    """
    if arguments and arguments[0] in COMMANDS:
        from inhand.outcomes_kept import ask

        return ask(arguments, OutcomesSettings)
    if arguments and arguments[0] in ASKED:
        from inhand.outcomes_pausing import ask_running

        return ask_running(arguments)
    kept, asked = (
        "; ".join(f"`inhand outcomes {verb}`: {text}" for verb, text in verbs.items())
        for verbs in (COMMANDS, ASKED)
    )
    epilog = f"What it keeps: {kept}. One that runs: {asked}"
    return daemon_main("outcomes", OutcomesSettings, run, arguments, check=check, epilog=epilog)
