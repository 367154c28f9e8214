"""Where a process may keep what it can make again."""

import os
from pathlib import Path

CACHE_VARIABLE = "INHAND_CACHE"


def cache_folder() -> Path:
    """Return the folder, which need not exist.

    It is ``INHAND_CACHE``; else that which systemd gives a service (``CacheDirectory=``); else
    ``inhand`` in the user's folder for caches.
    """
    if chosen := os.environ.get(CACHE_VARIABLE):
        return Path(chosen).absolute()
    if given := os.environ.get("CACHE_DIRECTORY"):
        return Path(given.split(os.pathsep)[0])
    if usual := os.environ.get("XDG_CACHE_HOME"):
        return Path(usual).absolute() / "inhand"
    return home() / ".cache/inhand"


def home() -> Path:
    """Return the user's home; the root folder for a user without one."""
    try:
        return Path.home()
    except RuntimeError:  # a user without a home, as in a container: nothing can be written there
        return Path("/")
