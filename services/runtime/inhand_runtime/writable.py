"""Whether a file or folder can be written, asked before the work that makes what goes into it."""

import tempfile
from pathlib import Path

from inhand_runtime.errors import SettingsError


def require_writable_file(path: Path) -> None:
    """Raise SettingsError unless a file of that name can be written; nothing is made."""
    try:
        if path.is_dir():
            raise SettingsError(f"cannot write {path}: it is a folder; name a file")
        if path.exists():
            with path.open("ab"):
                return
        try_folder(path.parent)
    except OSError as error:
        raise SettingsError(f"cannot write {path}: {error.strerror}; choose another file") from None


def require_writable_folder(path: Path) -> None:
    """Raise SettingsError unless files can be written to a folder; nothing is made."""
    try:
        try_folder(path)
    except OSError as error:
        raise SettingsError(
            f"cannot write to {path}: {error.strerror}; choose another folder"
        ) from None


def try_folder(path: Path) -> None:
    """Write to a folder, or to the one in which it would be made; raises OSError."""
    folder = path
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    with tempfile.TemporaryFile(dir=folder):
        pass
