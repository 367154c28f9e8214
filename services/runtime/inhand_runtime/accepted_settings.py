"""Settings as they were accepted: what a supervised process reads while its file is being changed.

Who supervises keeps the content in memory, and names it to its children by a variable.
"""

import os
from pathlib import Path

ACCEPTED_VARIABLE = "INHAND_ACCEPTED_SETTINGS"


class AcceptedSettings:
    """The content of a settings file, kept for the children of this process until it ends."""

    def __init__(self, path: Path, data: bytes) -> None:
        """Raises OSError."""
        descriptor = os.memfd_create("settings")
        with os.fdopen(descriptor, "wb", closefd=False) as file:
            file.write(data)
        self._descriptor = descriptor
        self._path = path.absolute()

    def environment(self) -> dict[str, str]:
        """Return the variable by which a child finds it; only the same user can read it."""
        source = f"/proc/{os.getpid()}/fd/{self._descriptor}"
        return {ACCEPTED_VARIABLE: f"{source}:{self._path}"}

    def close(self) -> None:
        """Forget it."""
        os.close(self._descriptor)


def accepted_data(path: Path) -> bytes | None:
    """Return the content of a settings file as the supervisor of this process accepted it; None
    where nobody supervises it, or another file is meant."""
    source, _, named = os.environ.get(ACCEPTED_VARIABLE, "").partition(":")
    if not source or Path(named) != path.absolute():
        return None
    try:
        return Path(source).read_bytes()
    except OSError:  # the supervisor is gone, and so is this process soon
        return None
