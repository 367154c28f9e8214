"""``python -m inhand_capture``: one capture daemon."""

import sys

from inhand_runtime.entry import daemon_main

from inhand_capture.service import run
from inhand_capture.settings import CaptureSettings, check

if __name__ == "__main__":
    sys.exit(daemon_main("capture", CaptureSettings, run, check=check))
