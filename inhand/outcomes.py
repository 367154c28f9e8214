"""``inhand outcomes``: the daemon of outcomes, or what it has kept."""

from collections.abc import Sequence

from inhand_outcomes.service import run
from inhand_outcomes.settings import OutcomesSettings, check
from inhand_runtime.entry import daemon_main


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the daemon until SIGTERM or Ctrl-C; returns the exit code."""
    return daemon_main("outcomes", OutcomesSettings, run, arguments, check=check)
