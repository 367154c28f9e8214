"""``inhand capture``: one capture daemon."""

from collections.abc import Sequence

from inhand_capture.service import run
from inhand_capture.settings import CaptureSettings, check
from inhand_runtime.entry import daemon_main
from inhand_runtime.exit_codes import DONE

LIST = "show the cameras that are attached, and what to write for them, and end"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the daemon until SIGTERM or Ctrl-C, or list cameras; returns its exit code."""
    return daemon_main(
        "capture",
        CaptureSettings,
        run,
        arguments,
        check=check,
        instead={"list": (LIST, list_cameras)},
    )


def list_cameras() -> int:
    """Print the cameras that are attached, and the settings for them."""
    # Loads depthai, which only this and the source need.
    from inhand_capture.sources.oak.devices import attached_cameras
    from inhand_capture.sources.oak.listing import listing

    print(listing(attached_cameras()))
    return DONE
