"""``inhand studio``: pages in the browser to watch a rig, teach it objects, and look at files."""

from collections.abc import Sequence

from inhand_runtime.entry import daemon_main
from inhand_studio.service import FOLDERS, check, run
from inhand_studio.settings import StudioSettings


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the daemon until SIGTERM or Ctrl-C; returns its exit code."""
    return daemon_main("studio", StudioSettings, run, arguments, check=check, folders=FOLDERS)
