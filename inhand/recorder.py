"""``inhand recorder``: one recorder daemon."""

from collections.abc import Sequence

from inhand_recorder.service import RecorderSettings, check, run
from inhand_runtime.entry import daemon_main


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the daemon until SIGTERM or Ctrl-C; returns its exit code."""
    return daemon_main("recorder", RecorderSettings, run, arguments, check=check)
