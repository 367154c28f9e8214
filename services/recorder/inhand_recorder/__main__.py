"""``python -m inhand_recorder``: one recorder daemon."""

import sys

from inhand_runtime.entry import daemon_main

from inhand_recorder.service import run
from inhand_recorder.settings import RecorderSettings, check

if __name__ == "__main__":
    sys.exit(daemon_main("recorder", RecorderSettings, run, check=check))
