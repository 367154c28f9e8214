"""Where a process may keep what it can make again."""

from pathlib import Path

from inhand_runtime.own_folder import own_folder

CACHE_VARIABLE = "INHAND_CACHE"


def cache_folder() -> Path:
    """Return the folder, which need not exist.

    It is ``INHAND_CACHE``; else that which systemd gives a service (``CacheDirectory=``); else
    ``inhand`` in the user's folder for caches.
    """
    return own_folder(CACHE_VARIABLE, "CACHE_DIRECTORY", "XDG_CACHE_HOME", ".cache")
