"""Where a process keeps files of its own."""

import os
from pathlib import Path


def own_folder(variable: str, systemd: str, user: str, usual: str) -> Path:
    """Return a folder, which need not exist.

    It is what the ``variable`` of the environment names; else what systemd names to a service in
    one of its own; else ``inhand`` in the folder that the ``user``'s variable names, or in the
    ``usual`` one below the user's home.
    """
    if chosen := os.environ.get(variable):
        return Path(chosen).absolute()
    if given := os.environ.get(systemd):
        return Path(given.split(os.pathsep)[0])
    if folder := os.environ.get(user):
        return Path(folder).absolute() / "inhand"
    return _home() / usual / "inhand"


def _home() -> Path:
    """Return the user's home; the root folder for a user without one."""
    try:
        return Path.home()
    except RuntimeError:  # a user without a home, as in a container: nothing can be written there
        return Path("/")
