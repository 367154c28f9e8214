"""Puts files into their places together: all of them, or none."""

import contextlib
import os
import shutil
from pathlib import Path
from types import TracebackType
from typing import Self

from inhand_runtime.private_file import sync_folder

from inhand.backup_file import PIECE_BYTES, Content, Stored


class Placement:
    """Writes files beside where they go, and gives them their names when all are whole.

    Unless ``commit`` has come to its end, the end of the block leaves all as it was before. Raises
    OSError.
    """

    def __init__(self) -> None:
        self.unknown: set[str] = set()
        """Users and groups whose files these were, and whom this system does not know."""
        self._staged: list[tuple[Path, Path]] = []
        self._placed: list[Path] = []
        self._former: list[tuple[Path, Path]] = []
        self._made: list[Path] = []
        self._done = False

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        _error: BaseException | None,
        _traceback: TracebackType | None,
    ) -> None:
        if not self._done:
            self._roll_back()

    def make_folder(self, path: Path, stored: Stored | None = None) -> None:
        """Make a folder and those above it, as it was stored where it is not there yet."""
        missing = [one for one in (path, *path.parents) if not one.exists()]
        for one in reversed(missing):
            one.mkdir()
            self._made.append(one)
        if stored is not None and path in missing:
            self._give(path, stored)

    def stage(self, path: Path, content: Content, stored: Stored) -> None:
        """Write a file of which the place is ``path``, beside it."""
        self.make_folder(path.parent)
        staged = path.with_name(f".{path.name}.restoring")
        staged.unlink(missing_ok=True)
        descriptor = os.open(staged, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        self._staged.append((staged, path))
        with os.fdopen(descriptor, "wb") as file:
            while data := content.read(PIECE_BYTES):
                file.write(data)
            file.flush()
            os.fsync(file.fileno())
        self._give(staged, stored)

    def commit(self) -> None:
        """Give all files their names; what was there before goes."""
        for staged, path in self._staged:
            if path.is_symlink() or path.exists():
                former = path.with_name(f".{path.name}.before")
                path.replace(former)
                self._former.append((former, path))
            staged.replace(path)
            self._placed.append(path)
        for folder in {path.parent for path in self._placed}:
            sync_folder(folder)
        self._done = True
        for former, _ in self._former:
            former.unlink()

    def _give(self, path: Path, stored: Stored) -> None:
        """Give a file or folder its mode, and, where root may, its owner and group."""
        path.chmod(stored.mode & 0o777)
        if os.geteuid() != 0:
            return
        for name, given in (
            (stored.owner, {"user": stored.owner}),
            (stored.group, {"group": stored.group}),
        ):
            try:
                shutil.chown(path, **given)
            except LookupError:
                self.unknown.add(name)

    def _roll_back(self) -> None:
        for path in reversed(self._placed):
            path.unlink(missing_ok=True)
        for former, path in reversed(self._former):
            former.replace(path)
        for staged, _ in self._staged:
            staged.unlink(missing_ok=True)
        for folder in reversed(self._made):
            with contextlib.suppress(OSError):  # somebody else put something there
                folder.rmdir()
