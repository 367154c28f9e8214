"""``python -m inhand_studio``: one studio daemon."""

import sys

from inhand_runtime.entry import daemon_main

from inhand_studio.service import FOLDERS, check, run
from inhand_studio.settings import StudioSettings

if __name__ == "__main__":
    sys.exit(daemon_main("studio", StudioSettings, run, check=check, folders=FOLDERS))
