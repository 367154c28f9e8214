"""``python -m inhand_tracker``: one tracker daemon."""

import sys

from inhand_runtime.entry import daemon_main

from inhand_tracker.loading import check
from inhand_tracker.service import run
from inhand_tracker.settings import TrackerSettings

if __name__ == "__main__":
    sys.exit(daemon_main("tracker", TrackerSettings, run, check=check))
