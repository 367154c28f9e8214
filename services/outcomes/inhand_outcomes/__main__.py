"""``python -m inhand_outcomes``: one daemon of outcomes."""

import sys

from inhand_runtime.entry import daemon_main

from inhand_outcomes.service import run
from inhand_outcomes.settings import OutcomesSettings, check

if __name__ == "__main__":
    sys.exit(daemon_main("outcomes", OutcomesSettings, run, check=check))
