"""``python -m inhand_hub``: one hub daemon."""

import sys

from inhand_runtime.entry import daemon_main

from inhand_hub.service import check, run
from inhand_hub.settings import HubSettings

if __name__ == "__main__":
    sys.exit(daemon_main("hub", HubSettings, run, check=check))
