"""``python -m inhand_recorder``: one recorder daemon."""

import sys

from inhand_runtime.entry import daemon_main

from inhand_recorder.service import RecorderSettings, check, run

if __name__ == "__main__":
    sys.exit(daemon_main("recorder", RecorderSettings, run, check=check))
