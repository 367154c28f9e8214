"""``inhand capture``: one capture daemon."""

from collections.abc import Sequence

from inhand_capture.service import CaptureSettings, check, run
from inhand_runtime.entry import daemon_main


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the daemon until SIGTERM or Ctrl-C; returns its exit code."""
    return daemon_main("capture", CaptureSettings, run, arguments, check=check)
