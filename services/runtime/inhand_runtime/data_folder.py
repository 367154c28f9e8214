"""Where a process finds what was fetched for it, which it cannot make again by itself."""

import os
from pathlib import Path

from inhand_runtime.cache_folder import home

DATA_VARIABLE = "INHAND_DATA"


def data_folder() -> Path:
    """Return the folder, which need not exist.

    It is ``INHAND_DATA``; else that which systemd gives a service (``StateDirectory=``); else
    ``inhand`` in the user's folder for data.
    """
    if chosen := os.environ.get(DATA_VARIABLE):
        return Path(chosen).absolute()
    if given := os.environ.get("STATE_DIRECTORY"):
        return Path(given.split(os.pathsep)[0])
    if usual := os.environ.get("XDG_DATA_HOME"):
        return Path(usual).absolute() / "inhand"
    return home() / ".local/share/inhand"
