"""Where a process finds what was fetched for it, which it cannot make again by itself."""

from pathlib import Path

from inhand_runtime.own_folder import own_folder

DATA_VARIABLE = "INHAND_DATA"


def data_folder() -> Path:
    """Return the folder, which need not exist.

    It is ``INHAND_DATA``; else that which systemd gives a service (``StateDirectory=``); else
    ``inhand`` in the user's folder for data.
    """
    return own_folder(DATA_VARIABLE, "STATE_DIRECTORY", "XDG_DATA_HOME", ".local/share")
