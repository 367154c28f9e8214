"""``inhand tracker``: one tracker daemon."""

from collections.abc import Sequence

from inhand_runtime.entry import daemon_main
from inhand_tracker.loading import check
from inhand_tracker.service import run
from inhand_tracker.settings import TrackerSettings


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the daemon until SIGTERM or Ctrl-C; returns its exit code."""
    return daemon_main("tracker", TrackerSettings, run, arguments, check=check)
